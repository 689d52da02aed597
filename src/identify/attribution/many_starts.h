// Least squares stop in the first valley that they come to. Where that is doubtful: a look at many starts, on few samples, and the refit
// from the most promising ones.
#pragma once

#include "identify/attribution/refit.h"

namespace heatsoak {

/// As refit(), from the model's own coordinates and from a Latin hypercube over what was known of them before. Deterministic. Throws
/// Failure (numerics_failed) where no start leads to a model that can be run.
RefitResult refit_from_many(const ExtendedModel& model, const std::vector<MeasuredRun>& runs,
                            const std::vector<std::vector<double>>& start_C, const RefitOptions& options);

}  // namespace heatsoak
