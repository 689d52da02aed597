// Dual number with up to eight derivative directions (forward-mode differentiation). A law written for `double` also runs on it.
#pragma once

#include <ceres/jet.h>

namespace heatsoak {

inline constexpr int kDirections = 8;
using Tangent = ceres::Jet<double, kDirections>;

}  // namespace heatsoak
