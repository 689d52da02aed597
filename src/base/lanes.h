// Number of parameter samples that are evaluated together (SIMD); thermal/lanes.h has their type.
#pragma once

namespace heatsoak::base {

inline constexpr int kLanes = 8;

}  // namespace heatsoak::base
