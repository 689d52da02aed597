#include "estimation/left_out_runs.h"

#include <cmath>

#include "base/parallel.h"

namespace heatsoak::estimation {

Posterior fit_of(const Model& model, const SomeRuns& some) { return try_posterior_of(model, some.runs, some.start_C, some.options); }

std::vector<Errors> errors_by_others(const Model& model, const std::vector<MeasuredRun>& runs,
                                     const std::vector<std::vector<double>>& start_C, const PosteriorOptions& options) {
  std::vector<Errors> errors(runs.size());
  base::in_parallel(runs.size(), 0, [&](std::size_t r) {
    const SomeRuns others = some_of(runs, start_C, options, [&](const MeasuredRun& run) { return &run != &runs[r]; });
    const Posterior fit = fit_of(model, others);
    if (std::isfinite(fit.evidence_nats)) {
      errors[r] = open_loop_errors(fit.model, {runs[r]}, others.runs);
    }
  });
  return errors;
}

}  // namespace heatsoak::estimation
