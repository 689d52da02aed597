// Compares the errors of two predictions of the same runs: by the original file and by the fitted one.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "calibration/forecast/prediction.h"
#include "estimation/open_loop.h"

namespace heatsoak::calibration {

struct ErrorBeforeAfter {
  std::string signal;
  estimation::SignalError before;
  estimation::SignalError after;
};

/// Returns the errors per signal, pooled over all runs. For the runs of one fit.
std::vector<ErrorBeforeAfter> errors_over_runs(const std::vector<PredictedRun>& before, const std::vector<PredictedRun>& after);

/// Returns the errors per signal in the run with the largest error after the fit. For hold-out runs: different conditions are not pooled.
std::vector<ErrorBeforeAfter> worst_errors(const std::vector<PredictedRun>& before, const std::vector<PredictedRun>& after);

/// Root of the mean square error over runs and signals, each with the same weight.
double rms_error_K(std::span<const PredictedRun> runs);

}  // namespace heatsoak::calibration
