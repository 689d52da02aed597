// Checks a robot's file for faults that otherwise only its use would reveal.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "motor/lint.h"
#include "robot/robot.h"

namespace heatsoak::robot {

/// Checks wheels, battery, inertia, the ability to stand and drive, and that the motor is one of `known_motors`. Throws Failure (bad_input)
/// if a robot that states its body cannot be built from it.
std::vector<motor::LintFinding> lint(const Robot& robot, std::span<const std::string> known_motors);

}  // namespace heatsoak::robot
