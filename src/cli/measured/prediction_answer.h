// Output of `predict`: JSON and a chart.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "calibration/forecast/prediction.h"
#include "report/chart.h"

namespace heatsoak {

/// Returns the answer in the schema heatsoak.prediction/1.
nlohmann::ordered_json prediction_json(const Motor& motor, const Prediction& prediction);
/// Returns one JSON object per run, with the keys of heatsoak.prediction/1.
nlohmann::ordered_json runs_json(const std::vector<PredictedRun>& runs);

/// Measured and predicted temperature with the 90 % band; one panel per signal and run.
Chart prediction_chart(const Motor& motor, const Prediction& prediction);

}  // namespace heatsoak
