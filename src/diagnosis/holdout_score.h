// Errors of motor files on hold-out runs, which influence no decision of the diagnosis.
#pragma once

#include <string>
#include <vector>

#include "calibration/forecast/prediction.h"
#include "diagnosis/findings.h"
#include "estimation/free_run_errors.h"
#include "estimation/measured_run.h"
#include "motor/motor.h"

namespace heatsoak::diagnosis {

/// The three motor files that are compared.
struct ScoredFiles {
  motor::Motor before;    ///< file that the user gave
  motor::Motor refitted;  ///< with only its own parameters refitted to the training runs
  motor::Motor after;     ///< with the effects that were found
};

/// Errors of the three files at one sensor in one run, each predicted from the first temperatures of the run.
struct HoldoutError {
  std::string run;
  std::string signal;  ///< "winding_C"
  estimation::ErrorOfSignal before;
  estimation::ErrorOfSignal refitted;
  estimation::ErrorOfSignal after;
};

struct HoldoutScore {
  std::vector<estimation::MeasuredRun> runs;
  std::vector<HoldoutError> errors;  ///< per run and signal; runs under different conditions are not pooled
  std::vector<calibration::PredictedRun> runs_before, runs_refitted, runs_after;
  std::vector<BeyondTraining> beyond_training;
};

/// Predicts the recordings from all three files with calibration::predict(). Returns an empty score without recordings.
HoldoutScore score_holdout(const ScoredFiles& files, const std::vector<recording::Recording>& holdout,
                           const calibration::PredictionOptions& options);

/// Returns the errors of each signal in the run in which the error after the diagnosis is largest.
std::vector<HoldoutError> worst_runs(const HoldoutScore& score);

/// Returns the RMS of a file's errors over the signals of one run, in K. `file` selects it: &HoldoutError::before.
double rms_of_run_K(const HoldoutScore& score, const std::string& run, estimation::ErrorOfSignal HoldoutError::*file);

}  // namespace heatsoak::diagnosis
