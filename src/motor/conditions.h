// Effects that were seen under a condition only: which of them predictions reckon with.
#pragma once

#include <map>
#include <span>
#include <string>

#include "motor/motor.h"

namespace heatsoak {

/// Where nobody says whether the condition holds, heat is reckoned with and cooling is not: an effect acts unless it takes heat out of
/// the hottest body it touches. `parameters` in the type's declared order.
bool acts_by_default(const MotorEffect& effect, std::span<const double> parameters);

/// The motor where "cooling" -> "fan" and the like are known to hold: effects under one of them act, those under another value of a key
/// do not. Throws Failure (bad_input) where a key is none of the motor's, with what it has.
Motor under(Motor motor, const std::map<std::string, std::string>& conditions);

}  // namespace heatsoak
