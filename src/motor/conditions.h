// Effects that hold only under a condition ("cooling" = "fan"), and which of them a prediction includes.
#pragma once

#include <map>
#include <span>
#include <string>

#include "motor/motor.h"

namespace heatsoak {

/// Returns whether an effect acts if its condition is unknown. The choice is pessimistic: it acts unless it cools the hottest node that it
/// touches. `parameters` in the type's declared order.
bool acts_by_default(const MotorEffect& effect, std::span<const double> parameters);

/// The motor where "cooling" -> "fan" and the like are known to hold: effects under one of them act, those under another value of a key
/// do not. Throws Failure (bad_input) where a key is none of the motor's, with what it has.
Motor under(Motor motor, const std::map<std::string, std::string>& conditions);

}  // namespace heatsoak
