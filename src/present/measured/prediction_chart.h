// Chart of `predict`.
#pragma once

#include "calibration/forecast/prediction.h"
#include "report/chart.h"

namespace heatsoak::present {

/// Returns measured and predicted temperature with the 90 % band; one panel per signal and run.
report::Chart prediction_chart(const motor::Motor& motor, const calibration::Prediction& prediction);

}  // namespace heatsoak::present
