// What was learned about friction, written into a robot's file.
#pragma once

#include <string>
#include <vector>

#include "identify/friction/friction_fit.h"
#include "robot/friction.h"
#include "robot/robot.h"

namespace heatsoak {

/// The text of the robot's file with new figures of origin "measured", everything else as it stands, comments included:
/// friction.wheel_damping is the mean of the wheels, [friction.heading] one table per wheel. As everywhere in robots'
/// files they are torques at the wheel without the drag and back-EMF of the motor, so that they hold for another motor
/// too; with the motor that they were measured with, steady_voltage_V() gives the measured voltages again. Where the
/// motor's drag or back-EMF alone is more than what was measured, 0 is written and said in `notes`.
/// Throws Failure: cannot_answer where a wheel was not learned; bad_input where the file has its friction in another form
/// than tables [friction] and [friction.heading].
std::string with_measured_friction(const std::string& text, const Robot& robot, const DriveConstants& drive, const FrictionFit& fit,
                                   const std::string& source, std::vector<std::string>& notes);

/// Only the damping, mechanical, of a roll-out.
std::string with_measured_damping(const std::string& text, const Robot& robot, const std::vector<Estimate>& wheel_damping_Nm_s_per_rad,
                                  const std::string& source);

}  // namespace heatsoak
