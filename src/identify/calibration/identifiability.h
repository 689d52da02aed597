// What the data leave open, in words, and the cheapest experiment that would settle it.
#pragma once

#include <vector>

#include "identify/calibration/calibrate.h"

namespace heatsoak {

/// Combinations of the parameters that the data tell worse than what was known before.
std::vector<OpenDirection> open_directions(const MotorModel& motor, const Fit& fit, std::span<const MeasuredRun> runs);

}  // namespace heatsoak
