// Reference operating point of effect sizes, so that sizes are comparable between files and close to one.
#pragma once

#include "thermal/scalar.h"

namespace heatsoak::thermal {

inline constexpr double kReferenceSpeed_rad_per_s = 500.0;
inline constexpr double kReferenceCurrent_A = 5.0;
inline constexpr double kReferenceBus_V = 24.0;

/// Returns a speed relative to the reference. Of Lanes the result refers to the argument.
template <class S>
auto speed_ratio(const S& speed_rad_per_s) {
  return named("speed_ratio", speed_rad_per_s / kReferenceSpeed_rad_per_s);
}

}  // namespace heatsoak::thermal
