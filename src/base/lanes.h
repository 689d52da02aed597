// Several parameter samples side by side: a law written for `double` runs on them unchanged.
#pragma once

#include <Eigen/Core>

namespace heatsoak {

inline constexpr int kLanes = 8;
using Lanes = Eigen::Array<double, kLanes, 1>;

}  // namespace heatsoak
