// A number that nobody measured or gave.
#pragma once

#include <limits>

namespace heatsoak {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace heatsoak
