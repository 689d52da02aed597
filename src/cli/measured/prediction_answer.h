// What `predict` hands out: text, JSON and a picture.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "identify/forecast/prediction.h"
#include "report/chart.h"

namespace heatsoak {

std::string prediction_text(const Motor& motor, const Prediction& prediction);

/// heatsoak.prediction/1.
nlohmann::ordered_json prediction_json(const Motor& motor, const Prediction& prediction);
/// Returns one JSON object per run, with the keys of heatsoak.prediction/1.
nlohmann::ordered_json runs_json(const std::vector<PredictedRun>& runs);

/// Measured, predicted and the 90 % band; one panel per signal and run.
Chart prediction_chart(const Motor& motor, const Prediction& prediction);

}  // namespace heatsoak
