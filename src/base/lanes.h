// Several parameter samples evaluated together (SIMD). A law written for `double` also runs on Lanes.
#pragma once

#include <Eigen/Core>

namespace heatsoak {

inline constexpr int kLanes = 8;
using Lanes = Eigen::Array<double, kLanes, 1>;

}  // namespace heatsoak
