// What `predict` hands out: text, JSON and a picture.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "identify/forecast/prediction.h"
#include "present/document.h"
#include "report/chart.h"

namespace heatsoak {

/// `warnings` say where the model does not hold. Of the notes of the prediction those `of_logs`, what was left out of them, come last.
present::Document prediction_document(const Motor& motor, const Prediction& prediction, std::span<const std::string> warnings,
                                      std::span<const std::string> of_logs);

/// heatsoak.prediction/1.
nlohmann::ordered_json prediction_json(const Motor& motor, const Prediction& prediction);
/// Returns one JSON object per run, with the keys of heatsoak.prediction/1.
nlohmann::ordered_json runs_json(const std::vector<PredictedRun>& runs);

/// Measured, predicted and the 90 % band; one panel per signal and run.
Chart prediction_chart(const Motor& motor, const Prediction& prediction);

}  // namespace heatsoak
