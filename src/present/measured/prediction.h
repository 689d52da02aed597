// Document and JSON of `predict`.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "calibration/forecast/prediction.h"
#include "calibration/training_range.h"
#include "present/document.h"
#include "present/json.h"

namespace heatsoak::present {

/// Returns the name of a predicted signal without its unit.
std::string signal_words(const PredictedSignal& signal);

/// Warns that a forecast leaves the range of the fitted runs.
std::string words_of(const OutsideTraining& finding);

/// Warns that the model was fitted to this run.
std::string fitted_run_words(std::string_view run);

/// `warnings` report where the model does not hold. The notes listed in `of_logs` (rejected samples) are printed last.
Document prediction_document(const Motor& motor, const Prediction& prediction, std::span<const std::string> warnings,
                             std::span<const std::string> of_logs);

/// Returns the answer in the schema heatsoak.prediction/1.
Json prediction_json(const Motor& motor, const Prediction& prediction);
/// Returns one JSON object per run, with the keys of heatsoak.prediction/1.
Json runs_json(const std::vector<PredictedRun>& runs);

}  // namespace heatsoak::present
