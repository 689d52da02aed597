#include "calibration/prediction_job.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/collected_failures.h"
#include "calibration/forecast/forecast_setup.h"

namespace heatsoak::calibration {
namespace {

std::vector<PredictionWarning> warnings_of(const motor::MotorFit& fit, const std::vector<recording::Recording>& recordings) {
  std::vector<PredictionWarning> warnings;
  FittedRuns fitted;
  for (const recording::Recording& recording : recordings) {
    for (OutsideTraining& each : outside(fit.training, recording)) {
      warnings.emplace_back(std::move(each));
    }
    if (was_fitted_to(fit, recording)) {
      fitted.recordings.push_back(recording.name);
    }
  }
  if (!fitted.recordings.empty()) {
    warnings.emplace_back(std::move(fitted));
  }
  return warnings;
}

/// Throws the failures of all logs that cannot be read as runs; predict() would end at the first one.
void require_runs(const motor::Motor& motor, const std::vector<recording::Recording>& recordings, std::optional<double> ambient_C) {
  base::CollectedFailures failures;
  for (const recording::Recording& recording : recordings) {
    failures.attempt([&] {
      std::vector<estimation::RunNote> notes;
      return forecast_runs(forecast_setup(motor, {&recording, 1}), {&recording, 1}, ambient_C, notes);
    });
  }
  failures.throw_if_any();
}

}  // namespace

PredictionAnswer run_prediction(const PredictionJob& job) {
  const recording::LogChoice& choice = job.logs.choice;
  const std::vector<recording::Recording>& recordings = job.logs.held_out;
  PredictionAnswer answer;
  answer.admission = admit(job.motor, job.logs);
  if (recordings.size() > 1) {
    require_runs(job.motor, recordings, choice.ambient_C);
  }
  answer.prediction = predict(job.motor, recordings, {.ambient_C = choice.ambient_C});
  if (job.motor.fit) {
    answer.warnings = warnings_of(*job.motor.fit, recordings);
  }
  std::ranges::copy(answer.prediction.missing, std::back_inserter(answer.warnings));
  return answer;
}

}  // namespace heatsoak::calibration
