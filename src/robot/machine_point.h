// Operating point of a motor from its current and speed. S is double, Lanes, or Traced for the observer of the firmware.
#pragma once

#include "motor/motor.h"
#include "robot/robot.h"
#include "thermal/operating_point.h"

namespace heatsoak::robot {

/// Returns the electrical power into the motor: copper loss at 25 °C, drag and shaft power. `speed_rad_per_s` is |ω|.
template <class S>
S input_power_W(const motor::MotorValues& motor, const S& heating_current_A, const S& shaft_power_W, const S& speed_rad_per_s);

/// Returns the part of an operating point that follows from current and speed alone, without headroom and vehicle speed. `current_A` and
/// `velocity_rad_per_s` have the same sign when driving.
template <class S>
thermal::OperatingPoint<S> machine_point(const motor::MotorValues& motor, const Robot& robot, const S& current_A,
                                         const S& velocity_rad_per_s, const S& shaft_power_W);

}  // namespace heatsoak::robot
