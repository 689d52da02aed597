// Voltages expected before a fit: from the robot file, else from the motor's data sheet.
#pragma once

#include "friction/friction_fit.h"
#include "motor/motor.h"
#include "robot/friction.h"

namespace heatsoak::friction {

/// Voltages that the fit compares its result with.
struct Expectation {
  ExpectedVoltages voltages;
  ExpectedFrom from = ExpectedFrom::robot_file;
  double damping_V_s_per_rad = 0.0;
};

/// Returns the expectation. It follows from the friction in the robot file if the file describes the body, else from back-EMF and drag of
/// the motor alone.
Expectation expectation(const robot::Robot& robot, const motor::MotorValues& motor);

}  // namespace heatsoak::friction
