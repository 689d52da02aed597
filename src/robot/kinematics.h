// Planar kinematics of a robot on omni wheels: body motion and wheel speeds, wheel forces and body wrench.
#pragma once

#include <array>

#include "robot/robot.h"

namespace heatsoak::robot {

// Frames. Global: fixed to the field, x towards the right goal. Local: fixed to the robot, origin on the axis of the wheel circle, x
// straight ahead, y to the left. Yaw is the angle from the global to the local x axis. Angles are positive counter-clockwise. (RoboTeam
// Twente, ETDP 2025, section 2.1.)

/// Position and heading in the global frame.
struct Pose {
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;
};

/// Velocity of the origin of the local frame, in components of the frame that the variable's name states.
struct BodyVelocity {
  double x_m_per_s = 0.0;
  double y_m_per_s = 0.0;
  double yaw_rad_per_s = 0.0;
  bool operator==(const BodyVelocity&) const = default;
};

/// Acceleration of that point in the inertial frame, in components like BodyVelocity. In local components it differs from the time
/// derivative of the velocity components, because the axes rotate; see acceleration_from_rates().
struct BodyAcceleration {
  double x_m_per_s2 = 0.0;
  double y_m_per_s2 = 0.0;
  double yaw_rad_per_s2 = 0.0;
  bool operator==(const BodyAcceleration&) const = default;
};

/// Force, and moment about the origin of the local frame.
struct Wrench {
  double x_N = 0.0;
  double y_N = 0.0;
  double yaw_Nm = 0.0;
  bool operator==(const Wrench&) const = default;
};

// Conversions of components between the global and the local frame of a robot with this yaw angle.
BodyVelocity to_local(const BodyVelocity& global, double yaw_rad);
BodyVelocity to_global(const BodyVelocity& local, double yaw_rad);
BodyAcceleration to_local(const BodyAcceleration& global, double yaw_rad);
BodyAcceleration to_global(const BodyAcceleration& local, double yaw_rad);
Wrench to_local(const Wrench& global, double yaw_rad);
Wrench to_global(const Wrench& local, double yaw_rad);

/// Returns a = dv/dt + yaw rate × v, with `rates` the time derivatives of the local components.
BodyAcceleration acceleration_from_rates(const BodyVelocity& local, const BodyAcceleration& rates);
/// Returns dv/dt = a − yaw rate × v.
inline BodyAcceleration rates_from_acceleration(const BodyVelocity& local, const BodyAcceleration& acceleration) {
  return {acceleration.x_m_per_s2 + local.yaw_rad_per_s * local.y_m_per_s, acceleration.y_m_per_s2 - local.yaw_rad_per_s * local.x_m_per_s,
          acceleration.yaw_rad_per_s2};
}

inline constexpr int kMostWheels = 4;
/// One value per wheel, wheel 1 first; the fourth is 0 for a robot with three wheels.
using PerWheel = std::array<double, kMostWheels>;

/// Directions of one wheel, from its axle angle α (robot file, `axis_angles`). The axle points outward along
/// e = (cos α, sin α), and the contact point lies at contact radius · e. The wheel rolls along t = (−sin α, cos α),
/// which is e turned a quarter counter-clockwise. A positive wheel speed moves the contact point along +t, so that
/// all wheels positive turn the robot counter-clockwise. A motor's speed and torque have the wheel's sign.
///
/// Worked example, wheel 1 (front right) of RoboTeam Twente: α = −30°, e = (0.866, −0.5), t = (0.5, 0.866). Straight
/// ahead it turns with +0.5·v/r, to the left with +0.866·v/r. Wheel 2 (front left), α = 30°: −0.5·v/r straight ahead.
struct WheelDirections {
  double axle_x_share = 0.0;
  double axle_y_share = 0.0;
  double rolling_x_share = 0.0;
  double rolling_y_share = 0.0;
};

/// Directions t and e of the wheels and matrices derived from them. With one row [t_x t_y R] of J per wheel (R contact radius, r wheel
/// radius), r·ω = J·v, and the wrench of the rolling forces is Jᵀ·f; J⁺ = (JᵀJ)⁻¹Jᵀ.
struct Kinematics {
  int wheel_count = 0;
  double wheel_radius_m = 1.0;
  double contact_radius_m = 1.0;
  std::array<WheelDirections, kMostWheels> wheels{};
  /// Rows of J⁺: x and y are dimensionless, yaw has the unit 1/m.
  PerWheel inverse_x_factor{};
  PerWheel inverse_y_factor{};
  PerWheel inverse_yaw_per_m{};
  /// Self-balancing force pattern of four wheels that moves nothing: Jᵀ·n = 0, Σn² = 1; 0 for three wheels.
  PerWheel inner_share{};
};

/// Throws Failure (bad_input) for more than four wheels, or if the axle directions do not allow motion in every direction.
Kinematics make_kinematics(const Robot& robot);

/// Returns the speed of each contact point along its rolling direction, t·v + R·yaw rate. It equals the rim speed of a wheel without slip.
inline PerWheel rolling_speeds_m_per_s(const Kinematics& kinematics, const BodyVelocity& local) {
  PerWheel speed_m_per_s{};
  for (int i = 0; i < kinematics.wheel_count; ++i) {
    const WheelDirections& wheel = kinematics.wheels[i];
    speed_m_per_s[i] = wheel.rolling_x_share * local.x_m_per_s + wheel.rolling_y_share * local.y_m_per_s +
                       kinematics.contact_radius_m * local.yaw_rad_per_s;
  }
  return speed_m_per_s;
}
/// Returns the speed of each contact point along its axle, e·v, at which the rollers turn.
inline PerWheel lateral_speeds_m_per_s(const Kinematics& kinematics, const BodyVelocity& local) {
  PerWheel speed_m_per_s{};
  for (int i = 0; i < kinematics.wheel_count; ++i) {
    const WheelDirections& wheel = kinematics.wheels[i];
    speed_m_per_s[i] = wheel.axle_x_share * local.x_m_per_s + wheel.axle_y_share * local.y_m_per_s;
  }
  return speed_m_per_s;
}

/// Returns ω = J·v/r for wheels without slip.
inline PerWheel wheel_speeds_rad_per_s(const Kinematics& kinematics, const BodyVelocity& local) {
  PerWheel speed = rolling_speeds_m_per_s(kinematics, local);
  for (double& each : speed) {
    each /= kinematics.wheel_radius_m;
  }
  return speed;
}

/// Returns v = r·J⁺·ω: for inconsistent speeds of four wheels the least-squares solution.
BodyVelocity body_velocity(const Kinematics& kinematics, const PerWheel& wheel_speed_rad_per_s);

/// Returns the forces along the rolling directions that produce a wrench, f = J⁺ᵀ·w; with four wheels those of least Σf².
inline PerWheel rolling_forces_N(const Kinematics& kinematics, const Wrench& local) {
  PerWheel force_N{};
  for (int i = 0; i < kinematics.wheel_count; ++i) {
    force_N[i] = kinematics.inverse_x_factor[i] * local.x_N + kinematics.inverse_y_factor[i] * local.y_N +
                 kinematics.inverse_yaw_per_m[i] * local.yaw_Nm;
  }
  return force_N;
}

/// Returns the wrench of forces on the contact points along the rolling directions.
inline Wrench wrench_of_rolling_forces(const Kinematics& kinematics, const PerWheel& force_N) {
  Wrench wrench;
  for (int i = 0; i < kinematics.wheel_count; ++i) {
    wrench.x_N += kinematics.wheels[i].rolling_x_share * force_N[i];
    wrench.y_N += kinematics.wheels[i].rolling_y_share * force_N[i];
    wrench.yaw_Nm += kinematics.contact_radius_m * force_N[i];
  }
  return wrench;
}
/// Returns the wrench of forces along the axles; they have no moment about the origin.
inline Wrench wrench_of_lateral_forces(const Kinematics& kinematics, const PerWheel& force_N) {
  Wrench wrench;
  for (int i = 0; i < kinematics.wheel_count; ++i) {
    wrench.x_N += kinematics.wheels[i].axle_x_share * force_N[i];
    wrench.y_N += kinematics.wheels[i].axle_y_share * force_N[i];
  }
  return wrench;
}

}  // namespace heatsoak::robot
