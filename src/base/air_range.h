// Possible temperatures of the air around a motor, for every file and option that states one.
#pragma once

#include "base/parameter.h"

namespace heatsoak::base {

/// From the coldest climatic chambers to an oven in which hot motors are recorded. No motor has a winding limit above it, so warmer air is
/// a wrong unit or a wrong key.
inline constexpr Range kPossibleAir_C = Range::between(-60.0, 200.0);

}  // namespace heatsoak::base
