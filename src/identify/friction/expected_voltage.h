// Voltages that a robot's file, or else its motor's data sheet, makes expect.
#pragma once

#include <string>

#include "identify/friction/friction_fit.h"
#include "motor/motor.h"
#include "robot/friction.h"

namespace heatsoak {

struct Expectation {
  ExpectedVoltages voltages;
  std::string from;  ///< "the robot's file", "the motor's data sheet"
  double damping_V_s_per_rad = 0.0;
};

/// By the friction of the robot's file, where it has the tables that motion needs; else only back-EMF and drag of the motor.
Expectation expectation(const Robot& robot, const MotorValues& motor);

}  // namespace heatsoak
