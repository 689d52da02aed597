// The robot as a rigid body on wheels with one kind of motor in it: what inverse and forward dynamics share.
#pragma once

#include <cmath>

#include "motor/motor.h"
#include "robot/friction.h"
#include "robot/kinematics.h"
#include "robot/robot.h"
#include "robot/traction.h"

namespace heatsoak {

struct BodyConfig {
  Kinematics kinematics;
  WeightConfig weight;
  TractionConfig traction;
  FrictionConfig friction;
  double rolling_efficiency = 1.0;
  double yaw_inertia_kg_m2 = 0.0;    ///< about the centre of gravity
  double wheel_inertia_kg_m2 = 0.0;  ///< wheel and rotor·gear ratio², at the wheel
};

/// Needs the tables body, wheels, friction and traction of the robot's file and the rotor inertia of the motor;
/// throws Failure (bad_input) that names all figures that are missing. Where the file has a measured curve of
/// friction over the direction of travel, it stands in place of wheel torque and roller drag.
BodyConfig make_body(const Robot& robot, const MotorValues& motor);

/// Force and moment about the origin that give the body an acceleration of the origin (local axes):
/// F = m·(a + dω/dt × c − ω²·c), M = I·dω/dt + c × F, c the offset of the centre of gravity.
Wrench wrench_of_acceleration(const BodyConfig& body, double yaw_rad_per_s, const BodyAcceleration& acceleration);
/// And back.
inline BodyAcceleration acceleration_of_wrench(const BodyConfig& body, double yaw_rad_per_s, const Wrench& wrench) {
  const double offset_x_m = body.weight.center_of_gravity_x_m;
  const double offset_y_m = body.weight.center_of_gravity_y_m;
  const double square_rad2_per_s2 = yaw_rad_per_s * yaw_rad_per_s;
  const double yaw_rad_per_s2 = (wrench.yaw_Nm - offset_x_m * wrench.y_N + offset_y_m * wrench.x_N) / body.yaw_inertia_kg_m2;
  return {wrench.x_N / body.weight.mass_kg + yaw_rad_per_s2 * offset_y_m + square_rad2_per_s2 * offset_x_m,
          wrench.y_N / body.weight.mass_kg - yaw_rad_per_s2 * offset_x_m + square_rad2_per_s2 * offset_y_m, yaw_rad_per_s2};
}

/// ½·m·v² of the centre of gravity + ½·I·ω² + Σ ½·J·ω_i².
double kinetic_energy_J(const BodyConfig& body, const BodyVelocity& local, const PerWheel& wheel_speed_rad_per_s);

/// Loss torque as a part of |torque|, with the sign of the speed: `driving_ratio` if torque and speed have the same sign,
/// `braking_ratio` otherwise. `sign` is smooth_sign() of the speed. S is double or Wheels.
template <class S>
S loss_torque_Nm(double driving_ratio, double braking_ratio, const S& torque_Nm, const S& sign) {
  using std::abs;
  return 0.5 * (driving_ratio + braking_ratio) * abs(torque_Nm) * sign + 0.5 * (driving_ratio - braking_ratio) * torque_Nm * abs(sign);
}

/// Torque that a transmission takes from the wheel besides what it hands on, signed like `speed`: it turns against
/// it. `output` is the torque after the losses: driving, the input is output/η; braking, η·output.
/// The sign of the speed is smoothed over `smoothing`.
double transmission_loss_Nm(double efficiency, double output_Nm, double speed_rad_per_s, double smoothing_rad_per_s);

}  // namespace heatsoak
