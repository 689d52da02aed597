// What only the use of a robot's file would find.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "motor/lint.h"
#include "robot/robot.h"

namespace heatsoak {

/// Whether the robot can stand and drive, and whether its motor is one of `known_motors`. Throws Failure (bad_input) where a robot that
/// states its body cannot be built from it.
std::vector<LintFinding> lint(const Robot& robot, std::span<const std::string> known_motors);

}  // namespace heatsoak
