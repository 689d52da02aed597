// Conditions and input ranges of the runs that a model was fitted to, and a check whether a log is outside them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "motor/fit_table.h"
#include "recording/recording.h"

namespace heatsoak {

/// Adds the conditions, ambient temperatures, speeds and currents of the recordings to `range`. The limits are the 1st and 99th percentile,
/// so that single outliers do not widen the range.
void widen(TrainingRange& range, std::span<const Recording> recordings);

/// Returns one sentence for each condition of the recording that no fitted run had, and for each input outside the range of the fitted
/// runs. Empty if `range` is empty.
std::vector<std::string> outside(const TrainingRange& range, const Recording& recording);

}  // namespace heatsoak
