// Fits to some of the runs, and predictions of the runs that such a fit did not use.
#pragma once

#include <vector>

#include "estimation/free_run_errors.h"
#include "estimation/posterior.h"

namespace heatsoak::estimation {

/// Some of the runs, with their start temperatures, weights and averaging.
struct SomeRuns {
  std::vector<MeasuredRun> runs;
  std::vector<std::vector<double>> start_C;
  PosteriorOptions options;
};

/// Returns the runs for which `belongs(run)` is true.
template <class Predicate>
SomeRuns some_of(const std::vector<MeasuredRun>& runs, const std::vector<std::vector<double>>& start_C, const PosteriorOptions& options,
                 Predicate belongs) {
  SomeRuns part{{}, {}, options};
  part.options.weights.clear();
  part.options.merged.clear();
  for (std::size_t r = 0; r < runs.size(); ++r) {
    if (belongs(runs[r])) {
      part.runs.push_back(runs[r]);
      part.start_C.push_back(start_C[r]);
      if (!options.weights.empty()) {
        part.options.weights.push_back(options.weights[r]);
      }
      if (!options.merged.empty()) {
        part.options.merged.push_back(options.merged[r]);
      }
    }
  }
  return part;
}

/// Fits the model to these runs; the evidence is −∞ if the fit fails.
Posterior fit_of(const Model& model, const SomeRuns& some);

/// Returns the RMS errors of each run, predicted with parameters from a fit to all other runs; empty errors if that fit fails. `start_C` as
/// in posterior_of(); weights and averaging in `options` are per run.
std::vector<Errors> errors_by_others(const Model& model, const std::vector<MeasuredRun>& runs,
                                     const std::vector<std::vector<double>>& start_C, const PosteriorOptions& options);

/// Returns the error of `model` divided by that of `other`, for runs predicted with fits to all other runs. The ratio is the geometric mean
/// over the runs, so that one run outside the range of the others does not decide. ∞ if a fit of `model` fails. `start_C` and `other_C`:
/// the start temperatures of the two models.
double left_out_ratio(const Model& model, const std::vector<std::vector<double>>& start_C, const Model& other,
                      const std::vector<std::vector<double>>& other_C, const std::vector<MeasuredRun>& runs,
                      const PosteriorOptions& options);

/// Returns `fit`, or a fit with the options `plain` that starts from it if that predicts the last thirds of the runs better after a fit to
/// the first two thirds. The difference of the two is added to the covariance. `own`: the options of `fit`. Weights and averaging are per
/// run.
Posterior more_predictive(Posterior fit, const std::vector<MeasuredRun>& runs, const PosteriorOptions& own, const PosteriorOptions& plain);

}  // namespace heatsoak::estimation
