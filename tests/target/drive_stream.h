// Inputs of the drive core over a minute of play, from the host's build of the core with a simple simulated robot.
#pragma once

#include <vector>

#include "image/drive_records.h"

namespace heatsoak::target {

/// Difference from a usual minute of play: one step in ten takes 1 to 3 periods; or all commands are pose targets; or one wheel sensor is
/// lost permanently after a second, without other faults.
enum class Play { usual, late_steps, pose_targets, lost_wheel_sensor };

/// 60000 inputs at the Config's period: commands that change 60 times per second, sensors with noise, and faults of sensors and radio link
/// in the last third.
std::vector<robot_core::Input> minute_of_play(unsigned seed, Play play);

}  // namespace heatsoak::target
