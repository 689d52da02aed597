// Notes about a robot that every answer that uses it must contain.
#pragma once

#include "present/document.h"
#include "robot/robot.h"

namespace heatsoak::present {

/// Adds a warning for each implausible value of the robot. Errors are refused when the file is read (robot::require_sound()).
void add_robot_notes(Document& document, const robot::Robot& robot);
/// Adds a warning with the values of robot::with_assumed_friction() if they were assumed.
void add_assumed_friction(Document& document, const robot::Robot& robot);

}  // namespace heatsoak::present
