// Conditions and ranges of the runs that a model was fitted to, and what a log has outside of them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "identify/measurement/recording.h"
#include "motor/fit_table.h"

namespace heatsoak {

/// Adds the conditions, ambient temperatures, speeds and currents of the recordings. Percentiles 1 and 99 stand for a range, so that
/// single wild samples do not widen it.
void widen(TrainingRange& range, std::span<const Recording> recordings);

/// One sentence for each condition of the recording that no fitted run had, and for each input that leaves the range of the fitted runs.
/// Empty where the model file records nothing.
std::vector<std::string> outside(const TrainingRange& range, const Recording& recording);

}  // namespace heatsoak
