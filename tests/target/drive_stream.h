// Inputs of the drive core over a minute of play, made with the host's build of the core against a simple robot.
#pragma once

#include <vector>

#include "image/drive_records.h"

namespace heatsoak::target {

/// 60 s at the Config's period: commands that change 60 times a second, sensors with noise; faults of sensors and link in the last third.
/// Pose targets only where `with_poses`, and then nothing else.
std::vector<robot_core::Input> minute_of_play(unsigned seed, bool with_poses);

}  // namespace heatsoak::target
