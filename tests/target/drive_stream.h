// Inputs of the drive core over a minute of play, from the host's build of the core with a simple simulated robot.
#pragma once

#include <vector>

#include "image/drive_records.h"

namespace heatsoak::target {

/// Inputs over 60 s at the Config's period: commands that change 60 times per second, sensors with noise, and faults of sensors and radio
/// link in the last third. With `with_poses` all commands are pose targets.
std::vector<robot_core::Input> minute_of_play(unsigned seed, bool with_poses);

}  // namespace heatsoak::target
