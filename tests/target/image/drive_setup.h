// A robot for the drive core in tests on the target: the same source on host and target.
#pragma once

#include "robot_core/drive_core.h"

namespace heatsoak::target {

/// RoboTeam Twente's robot of 2024 with the ECX FLAT 32 L, guard and planner; ready for start().
robot_core::Config drive_setup();

}  // namespace heatsoak::target
