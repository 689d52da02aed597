// The effects that a motor file adds: [effects.NAME], one table each.
#pragma once

#include "motor/motor.h"

namespace heatsoak {

/// Reads the table `effects` of the file, if there is one: those of the network and those of sensors. A node that an effect brings is named
/// after it, and other effects may name it too; the motor gets the effects in an order in which every node is there before it is named.
void read_effects(Reader& top, Motor& motor);

}  // namespace heatsoak
