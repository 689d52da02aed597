// Names of the drive core's reasons for traces and messages, equal to those of the enumerators.
#pragma once

#include <string_view>

#include "robot_core/reason.h"

namespace heatsoak::simulate {

/// Returns the name, for example "wheel_speed_stuck"; "unknown" for any other number.
std::string_view to_string(robot_core::Reason reason);

}  // namespace heatsoak::simulate
