// Where the sizes of effects are quoted, so that one watt means the same in every file and a size is near one.
#pragma once

namespace heatsoak {

inline constexpr double kReferenceSpeed_rad_per_s = 500.0;
inline constexpr double kReferenceCurrent_A = 5.0;
inline constexpr double kReferenceBus_V = 24.0;

}  // namespace heatsoak
