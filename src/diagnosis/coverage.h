// Detects predictions outside the range of the data that the model was fitted to.
#pragma once

#include <vector>

#include "diagnosis/findings.h"
#include "estimation/measured_run.h"

namespace heatsoak::diagnosis {

/// Returns the signals that are outside the range of `fitted` for more than a quarter of the time of `unseen`. The range is from
/// the 2nd to the 98th percentile, extended at both ends by 10 % of its width or of its upper end, whichever is larger.
std::vector<BeyondTraining> beyond_fitted(const std::vector<estimation::MeasuredRun>& fitted,
                                          const std::vector<estimation::MeasuredRun>& unseen);

}  // namespace heatsoak::diagnosis
