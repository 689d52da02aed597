// From what the body is to do to what its wheels must do, and how much of it the ground can pass on.
#pragma once

#include "robot/body.h"

namespace heatsoak {

/// All in the local frame.
struct BodyMotion {
  BodyVelocity velocity;
  BodyAcceleration acceleration;   ///< as seen from the field
  Wrench external;                 ///< on the body from outside: another robot, a wall, the ball; a push by the robot is minus this
  double external_height_m = 0.0;  ///< above the ground, where it acts
};

/// A point of a trajectory in the global frame, turned to the robot's.
BodyMotion local_motion(const BodyConfig& body, const Pose& pose, const BodyVelocity& velocity_global,
                        const BodyAcceleration& acceleration_global);

struct WheelDemands {
  PerWheel torque_Nm{};        ///< at the axle, after the gear, without the motor's own drag; > 0 drives forward along t
  PerWheel speed_rad_per_s{};  ///< of a wheel that does not slip
  PerWheel normal_force_N{};
  PerWheel rolling_force_N{};      ///< on the ground contact, as delivered
  PerWheel traction_use_ratio{};   ///< demanded rolling force per force that the contact can pass on; > 1 slips, infinite on a lifted wheel
  BodyAcceleration achievable;     ///< the demanded acceleration, or what is left of it
  Wrench untransmitted;            ///< demanded minus delivered, 0 where the contacts suffice
  double transmitted_share = 1.0;  ///< of the demanded acceleration; 0 where no share of it can be had
  bool lifted = false;             ///< a wheel has left the ground
};

/// Wheel torque T_i = loss(η, f_i·r) + f_i·r + friction_i(θ, ω) + J·dω_i/dt with the least Σf² that gives
///   Jᵀ·f = wrench(a) − external − roller drag.
/// Loads N_i follow from the acceleration demanded. A contact passes on √(μ² − c²)·N_i. Where that is too little for one
/// of four wheels, the others take over as far as they can: as much of the pattern that moves nothing (inner_share) as
/// needed. Where that is not enough, the acceleration is scaled down, direction kept; where no share of it helps,
/// because drag and push alone are too much, each contact gives what it can and the body accelerates as the sum
/// decides. A push at standstill is a stall: torque without speed.
WheelDemands inverse_dynamics(const BodyConfig& body, const BodyMotion& motion);

/// The largest force in that direction (local frame) that the robot can hold at a standstill without turning: beyond, a contact
/// slides whatever the others do. `height_m`: of what it pushes, above the ground.
double largest_push_N(const BodyConfig& body, double direction_rad, double height_m);

}  // namespace heatsoak
