// Names of the drive core's reasons for traces and messages: those of the enumeration.
#pragma once

#include <string_view>

#include "robot_core/reason.h"

namespace heatsoak::simulate {

/// "wheel_speed_stuck"; "unknown" for a number that is none of them.
std::string_view to_string(robot_core::Reason reason);

}  // namespace heatsoak::simulate
