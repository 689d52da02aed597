// Robots and a motor that the tests of this folder share.
#pragma once

#include <filesystem>
#include <numbers>
#include <random>

#include "motor/motor.h"
#include "robot/plant.h"
#include "robot/robot.h"
#include "support/shipped.h"

namespace heatsoak::robot {

/// Four wheels at right angles to each other without friction. Each test adds the losses that it needs.
inline Robot bare_robot() {
  Robot robot;
  robot.mass_kg = 2.5;
  robot.wheels.radius_m = 0.03;
  robot.wheels.contact_radius_m = 0.08;
  for (const double axis_deg : {-45.0, 45.0, 135.0, -135.0}) {
    robot.wheels.axis_rad.push_back(axis_deg * std::numbers::pi / 180.0);
  }
  robot.battery.nominal_V = 22.0;
  robot.body.yaw_inertia_kg_m2 = 0.01;
  robot.body.center_of_gravity_height_m = 0.05;
  robot.wheels.inertia_kg_m2 = 3e-5;
  robot.friction.wheel_torque_Nm = 0.0;
  robot.friction.wheel_damping_Nm_s_per_rad = 0.0;
  robot.friction.roller_drag_ratio = 0.0;
  robot.traction.coefficient_ratio = 0.7;
  robot.traction.slip_speed_m_per_s = 0.05;
  robot.drive.driver_resistance_ohm = 0.01;
  robot.drive.driver_standby_W = 0.5;
  robot.battery.full_V = 25.0;
  robot.battery.empty_V = 20.0;
  robot.battery.resistance_ohm = 0.05;
  robot.battery.capacity_A_s = 4680.0;
  return robot;
}

/// bare_robot() with all kinds of losses.
inline Robot lossy_robot() {
  Robot robot = bare_robot();
  robot.body.center_of_gravity_x_m = 0.004;
  robot.body.center_of_gravity_y_m = -0.003;
  robot.friction.wheel_torque_Nm = 0.003;
  robot.friction.wheel_damping_Nm_s_per_rad = 1e-4;
  robot.friction.roller_drag_ratio = 0.12;
  robot.friction.rolling_efficiency = 0.85;
  robot.drive.gear_ratio = 1.5;
  robot.drive.gear_efficiency = 0.9;
  return robot;
}

inline motor::MotorValues bare_motor() {
  motor::MotorValues motor;
  motor.terminal_resistance_ohm = 0.6;
  motor.torque_constant_Nm_per_A = 0.035;
  motor.no_load_current_A = 0.0;
  motor.temperature_coefficient_per_K = 0.0039;
  motor.rotor_inertia_kg_m2 = 1e-5;
  return motor;
}

inline motor::MotorValues lossy_motor() {
  motor::MotorValues motor = bare_motor();
  motor.no_load_current_A = 0.2;
  return motor;
}

inline double magnitude(const Wrench& wrench) { return std::abs(wrench.x_N) + std::abs(wrench.y_N) + std::abs(wrench.yaw_Nm) / 0.08; }

}  // namespace heatsoak::robot
