// Plane motion of a robot on omni wheels: body motion to wheel speeds and wheel forces to body force, and back.
#pragma once

#include <array>

#include "robot/robot.h"

namespace heatsoak {

// Frames. Global: fixed to the field, x towards the right goal. Local: on the robot, origin on the axis of the circle
// of its wheels, x straight ahead, y to its left. Yaw is the angle from the global to the local x axis. Angles count
// counter-clockwise. (RoboTeam Twente, ETDP 2025, section 2.1.)

/// In the global frame.
struct Pose {
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;
};

/// Velocity of the origin of the local frame, resolved along the axes of the frame that the variable's name says.
struct BodyVelocity {
  double x_m_per_s = 0.0;
  double y_m_per_s = 0.0;
  double yaw_rad_per_s = 0.0;
};

/// Acceleration of that point as seen from the field, resolved likewise. On local axes it is not the rate of change
/// of the velocity's components: those turn with the robot, see acceleration_from_rates().
struct BodyAcceleration {
  double x_m_per_s2 = 0.0;
  double y_m_per_s2 = 0.0;
  double yaw_rad_per_s2 = 0.0;
};

/// Force, and moment about the origin of the local frame.
struct Wrench {
  double x_N = 0.0;
  double y_N = 0.0;
  double yaw_Nm = 0.0;
};

BodyVelocity to_local(const BodyVelocity& global, double yaw_rad);
BodyVelocity to_global(const BodyVelocity& local, double yaw_rad);
BodyAcceleration to_local(const BodyAcceleration& global, double yaw_rad);
BodyAcceleration to_global(const BodyAcceleration& local, double yaw_rad);
Wrench to_local(const Wrench& global, double yaw_rad);
Wrench to_global(const Wrench& local, double yaw_rad);

/// a = dv/dt + yaw rate × v, where `rates` are the rates of change of the local components.
BodyAcceleration acceleration_from_rates(const BodyVelocity& local, const BodyAcceleration& rates);
/// dv/dt = a − yaw rate × v.
inline BodyAcceleration rates_from_acceleration(const BodyVelocity& local, const BodyAcceleration& acceleration) {
  return {acceleration.x_m_per_s2 + local.yaw_rad_per_s * local.y_m_per_s, acceleration.y_m_per_s2 - local.yaw_rad_per_s * local.x_m_per_s,
          acceleration.yaw_rad_per_s2};
}

inline constexpr int kMostWheels = 4;
/// One value per wheel, wheel 1 first; of a robot with three wheels the last is 0.
using PerWheel = std::array<double, kMostWheels>;

/// Directions of one wheel, from its axle angle α (robot file, `axis_angles`): the axle points outward along
/// e = (cos α, sin α), the contact point lies at contact radius · e, and the wheel rolls along t = (−sin α, cos α),
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

/// Rows t, e and what follows from them, calculated once. With J = [t_x t_y R] per wheel (R contact radius, r wheel
/// radius) r·ω = J·v and the wrench of the rolling forces is Jᵀ·f; J⁺ = (JᵀJ)⁻¹Jᵀ.
struct Kinematics {
  int wheel_count = 0;
  double wheel_radius_m = 1.0;
  double contact_radius_m = 1.0;
  std::array<WheelDirections, kMostWheels> wheels{};
  /// J⁺ without and with the unit: of x and y pure numbers, of yaw 1/m.
  PerWheel inverse_x_factor{};
  PerWheel inverse_y_factor{};
  PerWheel inverse_yaw_per_m{};
  /// Forces of four wheels that work against each other and move nothing, Jᵀ·n = 0, Σn² = 1; 0 for three wheels.
  PerWheel inner_share{};
};

/// Throws Failure (bad_input) for more than four wheels, or where all axles are alike so that the robot cannot be
/// driven in every direction.
Kinematics make_kinematics(const Robot& robot);

/// Speed of the contact point along the wheel's rolling direction, t·v + R·yaw rate: what a wheel that does not slip
/// has at its rim.
PerWheel rolling_speeds_m_per_s(const Kinematics& kinematics, const BodyVelocity& local);
/// Speed of the contact points along the axles, e·v: taken by the rollers.
PerWheel lateral_speeds_m_per_s(const Kinematics& kinematics, const BodyVelocity& local);

/// ω = J·v/r of wheels that do not slip.
PerWheel wheel_speeds_rad_per_s(const Kinematics& kinematics, const BodyVelocity& local);

/// v = r·J⁺·ω: of four wheels that contradict each other the least squares of their slip.
BodyVelocity body_velocity(const Kinematics& kinematics, const PerWheel& wheel_speed_rad_per_s);

/// The forces along the rolling directions that make up a wrench, f = J⁺ᵀ·w: with four wheels the least Σf².
PerWheel rolling_forces_N(const Kinematics& kinematics, const Wrench& local);

/// Wrench of forces on the contact points along the rolling directions.
Wrench wrench_of_rolling_forces(const Kinematics& kinematics, const PerWheel& force_N);
/// Wrench of forces along the axles; they pass through the origin.
Wrench wrench_of_lateral_forces(const Kinematics& kinematics, const PerWheel& force_N);

}  // namespace heatsoak
