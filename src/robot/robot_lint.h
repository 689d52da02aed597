// Checks a robot's file for faults that otherwise only its use would reveal.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "motor/lint.h"
#include "robot/robot.h"

namespace heatsoak::robot {

/// Returns values that contradict each other or that no small robot has: wheels, battery, drive, inertia, motion. An error means that the
/// robot cannot exist, a warning that a value probably has another unit.
std::vector<motor::LintFinding> implausible_values(const Robot& robot);

/// Throws Failure (bad_input) with the errors of implausible_values(): no verdict and no firmware may use them.
void require_sound(const Robot& robot);

/// Reads a robot file and checks it like require_sound(). Throws Failure (bad_input).
Robot read_sound_robot(const std::filesystem::path& path);

/// Checks wheels, battery, inertia, the ability to stand and drive, and that the motor is one of `known_motors`. Throws Failure (bad_input)
/// if a robot that states its body cannot be built from it.
std::vector<motor::LintFinding> lint(const Robot& robot, std::span<const std::string> known_motors);

}  // namespace heatsoak::robot
