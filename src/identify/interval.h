// How wide the intervals are that everything learned from measurements is given with.
#pragma once

namespace heatsoak {

/// Standard deviations to either side of a normal distribution's mean that enclose 95 % of it.
inline constexpr double kInterval_sd = 1.959964;

}  // namespace heatsoak
