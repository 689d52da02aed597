// Range of air temperatures that files and options accept.
#pragma once

#include "base/parameter.h"

namespace heatsoak::base {

/// Accepted temperatures of the air around a motor: the coldest climatic chamber to the hottest oven for motors. Winding limits are lower
/// than 200 °C, so a higher value has a wrong unit or a wrong key.
inline constexpr Range kPossibleAir_C = Range::between(-60.0, 200.0);

}  // namespace heatsoak::base
