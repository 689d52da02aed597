// The value of a quantity that was neither measured nor given.
#pragma once

#include <limits>

namespace heatsoak::base {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace heatsoak::base
