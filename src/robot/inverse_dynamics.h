// Inverse dynamics: wheel torques and speeds for a motion of the body, and how much of it the ground contacts can transmit.
#pragma once

#include "robot/body.h"

namespace heatsoak::robot {

/// Motion of the body in the local frame.
struct BodyMotion {
  BodyVelocity velocity;
  BodyAcceleration acceleration;   ///< in the inertial frame of the field
  Wrench external;                 ///< wrench on the body from outside (robot, wall, ball); a push by the robot is its negative
  double external_height_m = 0.0;  ///< height above the ground where it acts
  bool operator==(const BodyMotion&) const = default;
};

/// Converts a point of a trajectory from the global frame to the robot's frame.
BodyMotion local_motion(const BodyConfig& body, const Pose& pose, const BodyVelocity& velocity_global,
                        const BodyAcceleration& acceleration_global);

/// The field's x axis in the local frame.
struct FieldAxis {
  double x_share = 1.0;
  double y_share = 0.0;
};
/// Returns the axis for a yaw angle.
FieldAxis field_axis(double yaw_rad);
/// Converts a motion from the field to the local frame, with an axis that the caller keeps while the robot does not turn.
BodyMotion local_motion(const BodyConfig& body, const FieldAxis& axis, const BodyVelocity& velocity_global,
                        const BodyAcceleration& acceleration_global);

/// Demands on the wheels, and the part of the motion that the contacts transmit.
struct WheelDemands {
  PerWheel torque_Nm{};        ///< at the axle, after the gear, without the motor's own drag; > 0 drives along t
  PerWheel speed_rad_per_s{};  ///< speed without slip
  PerWheel normal_force_N{};
  PerWheel rolling_force_N{};      ///< force on the ground contact that is transmitted
  PerWheel traction_use_ratio{};   ///< demanded rolling force per transmittable force; > 1 slips, infinite on a lifted wheel
  BodyAcceleration achievable;     ///< the demanded acceleration, or the part of it that is transmitted
  Wrench untransmitted;            ///< demanded minus transmitted; 0 if the contacts suffice
  double transmitted_share = 1.0;  ///< share of the demanded acceleration, 0 to 1
  bool lifted = false;             ///< a wheel has left the ground
};

/// Wheel torque T_i = loss(η, f_i·r) + f_i·r + friction_i(θ, ω) + J·dω_i/dt, with the least Σf² that gives
/// Jᵀ·f = wrench(a) − external − roller drag.
/// The normal loads N_i follow from the demanded acceleration. A contact transmits at most √(μ² − c²)·N_i. If one of four wheels exceeds
/// this limit, the others take over: as much of the self-balancing force pattern (inner_share) is added as needed. If that is not enough,
/// the acceleration is scaled down in its direction. If drag and push alone exceed the limits, each contact transmits its maximum and the
/// body accelerates accordingly. A push at standstill is a stall: torque without speed.
WheelDemands inverse_dynamics(const BodyConfig& body, const BodyMotion& motion);

/// Returns the largest force in N that the robot can exert in a direction (local frame) at standstill without sliding or turning.
/// `height_m` is the height of the contact with the pushed object above the ground.
double largest_push_N(const BodyConfig& body, double direction_rad, double height_m);

}  // namespace heatsoak::robot
