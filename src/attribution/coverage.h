// Where a prediction goes beyond what was fitted.
#pragma once

#include <string>
#include <vector>

#include "estimation/measured_run.h"

namespace heatsoak {

/// One sentence per signal whose values in `unseen` lie, for much of the time, outside of what `fitted` dwelt at.
std::vector<std::string> beyond_fitted(const std::vector<MeasuredRun>& fitted, const std::vector<MeasuredRun>& unseen);

}  // namespace heatsoak
