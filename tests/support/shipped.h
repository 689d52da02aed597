// Robots and motors shipped with the program.
#pragma once

#include <string>

#include "input/data_folders.h"
#include "motor/motor.h"
#include "robot/robot.h"
#include "support/source_folder.h"

namespace heatsoak {

inline robot::Robot shipped_robot(const std::string& id) {
  return robot::read_robot(input::file_of(kSource / "robot_core/robots", "robot", id));
}
inline motor::Motor shipped_motor(const std::string& id) { return motor::read_motor(input::file_of(kSource / "motor_db", "motor", id)); }

/// The paper's robot with the motor that failed in it.
inline robot::Robot twente() { return shipped_robot("roboteam_twente_v2024"); }
inline motor::Motor ecx_32() { return shipped_motor("maxon_ecx_flat_32l_48v"); }

}  // namespace heatsoak
