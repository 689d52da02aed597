// The effects that a motor file adds: [effects.NAME], one table each.
#pragma once

#include <vector>

#include "motor/motor.h"

namespace heatsoak {

/// Reads the table `effects` of the file, if there is one. A node that an effect brings is named after it, and other effects
/// may name it too; the result has the effects in an order in which every node is there before it is named.
std::vector<MotorEffect> read_effects(Reader& top);

}  // namespace heatsoak
