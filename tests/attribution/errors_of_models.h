// Errors of the models of a diagnosis on unseen runs, for motors that have no file.
#pragma once

#include <vector>

#include "diagnosis/diagnosis.h"
#include "estimation/free_run_errors.h"

namespace heatsoak::attribution {

/// Errors in free-running simulation, pooled over the runs.
struct ErrorsOfModels {
  std::vector<estimation::MeasuredRun> runs;
  estimation::Errors before;    ///< model as given
  estimation::Errors refitted;  ///< with only its own parameters refitted to the training runs
  estimation::Errors after;     ///< with effects and run deviations
};

/// Scores unseen runs, as read from their logs.
ErrorsOfModels errors_of_models(const diagnosis::DiagnosisInput& input, const diagnosis::Diagnosis& diagnosis,
                                std::vector<estimation::MeasuredRun> unseen);

}  // namespace heatsoak::attribution
