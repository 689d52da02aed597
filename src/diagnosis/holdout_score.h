// Errors of motor files on hold-out runs, which influence no decision of the diagnosis.
#pragma once

#include <string>
#include <vector>

#include "calibration/forecast/prediction.h"
#include "diagnosis/error_in_run.h"
#include "diagnosis/findings.h"
#include "estimation/measured_run.h"
#include "motor/motor.h"

namespace heatsoak::diagnosis {

/// The three motor files that are compared.
struct ScoredFiles {
  motor::Motor before;    ///< file that the user gave
  motor::Motor refitted;  ///< with only its own parameters refitted to the training runs
  motor::Motor after;     ///< with the effects that were found
};

struct HoldoutScore {
  std::vector<estimation::MeasuredRun> runs;
  std::vector<ErrorInRun> errors;  ///< errors of the three files, per run and signal
  std::vector<calibration::PredictedRun> runs_before, runs_refitted, runs_after;
  std::vector<BeyondTraining> beyond_training;
};

/// Predicts the recordings from all three files with calibration::predict(). Returns an empty score without recordings.
HoldoutScore score_holdout(const ScoredFiles& files, const std::vector<recording::Recording>& holdout,
                           const calibration::PredictionOptions& options);

/// Returns the RMS of a file's errors over the signals of one run, in K. `file` selects it: &ErrorInRun::before.
double rms_of_run_K(const HoldoutScore& score, const std::string& run, estimation::ErrorOfSignal ErrorInRun::*file);

}  // namespace heatsoak::diagnosis
