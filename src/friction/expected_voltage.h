// Voltages expected before a fit: from the robot file, else from the motor's data sheet.
#pragma once

#include <string>

#include "friction/friction_fit.h"
#include "motor/motor.h"
#include "robot/friction.h"

namespace heatsoak::friction {

struct Expectation {
  ExpectedVoltages voltages;
  std::string from;  ///< origin in words: "the robot's file" or "the motor's data sheet"
  double damping_V_s_per_rad = 0.0;
};

/// Returns the expectation from the friction in the robot file, if that describes the body; else from back-EMF and drag of the motor only.
Expectation expectation(const robot::Robot& robot, const motor::MotorValues& motor);

}  // namespace heatsoak::friction
