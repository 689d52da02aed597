// The answer of `predict`: checks the logs, predicts their temperatures, and reports conditions for which the model is not valid.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "calibration/admission.h"
#include "calibration/forecast/prediction.h"
#include "calibration/training_range.h"
#include "recording/named_logs.h"

namespace heatsoak::calibration {

struct PredictionJob {
  motor::Motor motor;
  recording::NamedLogs logs;  ///< `held_out` is predicted; no log is fitted
};

/// The model was fitted to these recordings, so their errors are not forecast errors.
struct FittedRuns {
  std::vector<std::string> recordings;  ///< at least one
};
using PredictionWarning = std::variant<OutsideTraining, FittedRuns, SignalsMissing>;

struct PredictionAnswer {
  Prediction prediction;
  Admission admission;
  std::vector<PredictionWarning> warnings;
};

/// Throws Failure as admit() and predict() do.
PredictionAnswer run_prediction(const PredictionJob& job);

}  // namespace heatsoak::calibration
