// Effects that hold only under a condition ("cooling" = "fan"), and which of them a prediction includes.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "motor/motor.h"

namespace heatsoak::motor {

/// Returns whether an effect acts if its condition is unknown. The choice is pessimistic: it acts unless it cools the hottest node that it
/// touches. `parameters` in the type's declared order.
bool acts_by_default(const MotorEffect& effect, std::span<const double> parameters);

/// Returns the motor with known conditions, such as "cooling" -> "fan": effects under another value of a key are removed, those under this
/// value become unconditional. Throws Failure (bad_input) if no effect of the motor has such a key, and not all runs of its fit had this
/// value; the message lists what is possible.
Motor under(Motor motor, const std::map<std::string, std::string>& conditions);

/// Returns whether a condition with this key changes the motor: an effect depends on it, or all runs of its fit had one value of it.
bool depends_on(const Motor& motor, const std::string& key);
/// Returns the motor with those of the conditions that it depends on.
Motor under_its_own(Motor motor, std::map<std::string, std::string> conditions);

/// Returns the stated conditions "key=value" (Motor::assumed) of whose key the fitted runs had other values only.
std::vector<std::string> conditions_without_runs(const Motor& motor);

/// Returns the conditions "key=value" that all runs of the motor's fit had, except those with effects of their own and those that
/// Motor::assumed states: the motor's values may hold only under them.
std::vector<std::string> unstated_fit_conditions(const Motor& motor);

}  // namespace heatsoak::motor
