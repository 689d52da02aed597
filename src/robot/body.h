// The robot as a rigid body on wheels with one type of motor; inverse and forward dynamics share it.
#pragma once

#include <cmath>

#include "motor/motor.h"
#include "robot/friction.h"
#include "robot/kinematics.h"
#include "robot/robot.h"
#include "robot/traction.h"

namespace heatsoak::robot {

/// Constants of the body and its wheels.
struct BodyConfig {
  Kinematics kinematics;
  WeightConfig weight;
  TractionConfig traction;
  FrictionConfig friction;
  double rolling_efficiency = 1.0;   ///< share of the wheel's torque that reaches the ground
  double yaw_inertia_kg_m2 = 0.0;    ///< about the centre of gravity
  double wheel_inertia_kg_m2 = 0.0;  ///< wheel plus rotor·(gear ratio)², at the wheel
};

/// Builds the body from the tables body, wheels, friction and traction of the robot's file and the rotor inertia of the motor. Throws
/// Failure (bad_input) with all missing values. If the file has a measured friction curve over the direction of travel, it replaces wheel
/// torque and roller drag.
BodyConfig make_body(const Robot& robot, const motor::MotorValues& motor);

/// Returns the force and the moment about the origin for an acceleration of the origin, in local axes. With c the offset of the centre of
/// gravity, F = m·(a + dω/dt × c − ω²·c) and M = I·dω/dt + c × F.
Wrench wrench_of_acceleration(const BodyConfig& body, double yaw_rad_per_s, const BodyAcceleration& acceleration);
/// Inverse of wrench_of_acceleration().
inline BodyAcceleration acceleration_of_wrench(const BodyConfig& body, double yaw_rad_per_s, const Wrench& wrench) {
  const double offset_x_m = body.weight.center_of_gravity_x_m;
  const double offset_y_m = body.weight.center_of_gravity_y_m;
  const double square_rad2_per_s2 = yaw_rad_per_s * yaw_rad_per_s;
  const double yaw_rad_per_s2 = (wrench.yaw_Nm - offset_x_m * wrench.y_N + offset_y_m * wrench.x_N) / body.yaw_inertia_kg_m2;
  return {wrench.x_N / body.weight.mass_kg + yaw_rad_per_s2 * offset_y_m + square_rad2_per_s2 * offset_x_m,
          wrench.y_N / body.weight.mass_kg - yaw_rad_per_s2 * offset_x_m + square_rad2_per_s2 * offset_y_m, yaw_rad_per_s2};
}

/// Returns ½·m·v² of the centre of gravity + ½·I·ω² + Σ ½·J·ω_i², in J.
double kinetic_energy_J(const BodyConfig& body, const BodyVelocity& local, const PerWheel& wheel_speed_rad_per_s);

/// Returns the loss torque, |torque| times a ratio, with the sign of the speed: `driving_ratio` if torque and speed have the same sign,
/// `braking_ratio` otherwise. `sign` is smooth_sign() of the speed. S is double or Wheels.
template <class S>
S loss_torque_Nm(double driving_ratio, double braking_ratio, const S& torque_Nm, const S& sign) {
  using std::abs;
  return 0.5 * (driving_ratio + braking_ratio) * abs(torque_Nm) * sign + 0.5 * (driving_ratio - braking_ratio) * torque_Nm * abs(sign);
}

}  // namespace heatsoak::robot
