#include "calibration/prediction_job.h"

#include <utility>

namespace heatsoak::calibration {
namespace {

std::vector<PredictionWarning> warnings_of(const motor::MotorFit& fit, const std::vector<recording::Recording>& recordings) {
  std::vector<PredictionWarning> warnings;
  for (const recording::Recording& recording : recordings) {
    for (OutsideTraining& each : outside(fit.training, recording)) {
      warnings.emplace_back(std::move(each));
    }
    if (was_fitted_to(fit, recording)) {
      warnings.emplace_back(FittedRun{recording.name});
    }
  }
  return warnings;
}

}  // namespace

PredictionAnswer run_prediction(const PredictionJob& job) {
  const recording::LogChoice& choice = job.logs.choice;
  const std::vector<recording::Recording>& recordings = job.logs.held_out;
  PredictionAnswer answer;
  answer.admission = admit(job.motor, {}, recordings, choice.takes_logs_as_they_are, choice.ambient_C);
  answer.prediction = predict(job.motor, recordings, {.ambient_C = choice.ambient_C});
  if (job.motor.fit) {
    answer.warnings = warnings_of(*job.motor.fit, recordings);
  }
  return answer;
}

}  // namespace heatsoak::calibration
