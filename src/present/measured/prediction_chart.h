// Chart of `predict`.
#pragma once

#include "calibration/forecast/prediction.h"
#include "report/chart.h"

namespace heatsoak::present {

/// Measured and predicted temperature with the 90 % band; one panel per signal and run.
Chart prediction_chart(const Motor& motor, const Prediction& prediction);

}  // namespace heatsoak::present
