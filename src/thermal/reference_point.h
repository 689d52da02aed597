// Reference operating point of effect sizes, so that sizes are comparable between files and close to one.
#pragma once

namespace heatsoak::thermal {

inline constexpr double kReferenceSpeed_rad_per_s = 500.0;
inline constexpr double kReferenceCurrent_A = 5.0;
inline constexpr double kReferenceBus_V = 24.0;

}  // namespace heatsoak::thermal
