// Errors of two predictions of the same runs side by side: by the file, and by what a fit made of it.
#pragma once

#include <string>
#include <vector>

#include "identify/forecast/prediction.h"
#include "identify/open_loop.h"

namespace heatsoak {

struct ErrorBeforeAfter {
  std::string signal;
  SignalError before;
  SignalError after;
};

/// Per signal, pooled over the runs: for runs that one fit was made to.
std::vector<ErrorBeforeAfter> errors_over_runs(const std::vector<PredictedRun>& before, const std::vector<PredictedRun>& after);

/// Per signal, of the run in which it is worst after the fit: runs under different conditions are not pooled.
std::vector<ErrorBeforeAfter> worst_errors(const std::vector<PredictedRun>& before, const std::vector<PredictedRun>& after);

}  // namespace heatsoak
