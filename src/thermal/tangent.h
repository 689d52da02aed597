// A number with its derivatives in up to eight directions: a law written for `double` runs on it unchanged.
#pragma once

#include <ceres/jet.h>

namespace heatsoak {

inline constexpr int kDirections = 8;
using Tangent = ceres::Jet<double, kDirections>;

}  // namespace heatsoak
