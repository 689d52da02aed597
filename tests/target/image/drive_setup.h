// Robot for tests of the drive core on the target; host and target use the same source.
#pragma once

#include "robot_core/drive_core.h"

namespace heatsoak::target {

/// Returns RoboTeam Twente's robot of 2024 with the ECX FLAT 32 L, guard and planner, ready for start().
robot_core::Config drive_setup();

}  // namespace heatsoak::target
