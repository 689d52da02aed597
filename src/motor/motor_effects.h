// Reads the effects that a motor file adds: one table [effects.NAME] each.
#pragma once

#include "motor/motor.h"

namespace heatsoak::motor {

/// Reads the table `effects`, if present: thermal effects and sensor errors. A node that an effect adds has the effect's name, and other
/// effects may use it. The motor gets the effects ordered so that every node is added before it is used. Adds problems to the reader's
/// diagnostics.
void read_effects(input::Reader& top, Motor& motor);

}  // namespace heatsoak::motor
