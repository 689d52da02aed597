// Errors per run: runs under different conditions are not pooled.
#pragma once

#include <string>
#include <vector>

#include "estimation/free_run_errors.h"

namespace heatsoak::diagnosis {

/// Errors at one sensor in one run, each predicted from the first temperatures of the run.
struct ErrorInRun {
  std::string run;
  std::string signal;                  ///< "winding_C"
  estimation::ErrorOfSignal before;    ///< errors of the model or file that the user gave
  estimation::ErrorOfSignal refitted;  ///< errors with only its own parameters refitted to the training runs
  estimation::ErrorOfSignal after;     ///< errors with the effects that were found
  estimation::ErrorOfSignal file;      ///< errors of the written file alone, without run deviations
};

/// Returns the errors of each signal in the run in which the error after the diagnosis is largest.
std::vector<ErrorInRun> worst_runs(const std::vector<ErrorInRun>& errors);

}  // namespace heatsoak::diagnosis
