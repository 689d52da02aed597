// Effects that hold only under a condition ("cooling" = "fan"), and which of them a prediction includes.
#pragma once

#include <map>
#include <span>
#include <string>

#include "motor/motor.h"

namespace heatsoak::motor {

/// Returns whether an effect acts if its condition is unknown. The choice is pessimistic: it acts unless it cools the hottest node that it
/// touches. `parameters` in the type's declared order.
bool acts_by_default(const MotorEffect& effect, std::span<const double> parameters);

/// Returns the motor with known conditions, such as "cooling" -> "fan": effects under another value of a key are removed, those under this
/// value become unconditional. Throws Failure (bad_input) if no effect of the motor has such a key; the message lists the existing ones.
Motor under(Motor motor, const std::map<std::string, std::string>& conditions);

}  // namespace heatsoak::motor
