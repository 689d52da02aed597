// Operating point of a motor from its current and speed. The scalar type is double or Traced, for the observer of the firmware.
#pragma once

#include "motor/motor.h"
#include "robot/motor_drive.h"
#include "robot/robot.h"
#include "thermal/operating_point.h"
#include "thermal/scalar.h"

namespace heatsoak {

/// Returns the electrical power into the motor: copper loss at 25 °C, drag and shaft power. `speed_rad_per_s` is |ω|.
template <class S>
S input_power_W(const MotorValues& motor, const S& heating_current_A, const S& shaft_power_W, const S& speed_rad_per_s) {
  return heating_current_A * heating_current_A * motor.terminal_resistance_ohm + shaft_power_W + drag_torque_Nm(motor) * speed_rad_per_s;
}

/// The part of an operating point that follows from current and speed alone; without headroom and vehicle speed. S is a number or a
/// formula. `current_A` and `velocity_rad_per_s` have the same sign when driving.
template <class S>
OperatingPoint<S> machine_point(const MotorValues& motor, const Robot& robot, const S& current_A, const S& velocity_rad_per_s,
                                const S& shaft_power_W) {
  OperatingPoint<S> at;
  at.current_rms_A = magnitude(current_A) * heating_factor(robot);
  at.speed_mean_rad_per_s = magnitude(velocity_rad_per_s);
  at.speed_rms_rad_per_s = at.speed_mean_rad_per_s;
  at.velocity_rad_per_s = velocity_rad_per_s;
  at.shaft_power_W = shaft_power_W;
  at.input_power_W = input_power_W(motor, at.current_rms_A, shaft_power_W, at.speed_mean_rad_per_s);
  at.bus_V = robot.battery.nominal_V;
  const S terminal_V = current_A * motor.terminal_resistance_ohm + motor.torque_constant_Nm_per_A * velocity_rad_per_s;
  const S modulation_ratio = magnitude(terminal_V + current_A * robot.series_resistance_ohm()) / robot.battery.nominal_V;
  at.modulation_ratio = modulation_ratio - positive_part(modulation_ratio - 1.0);
  return at;
}

}  // namespace heatsoak
