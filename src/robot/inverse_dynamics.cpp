#include "robot/inverse_dynamics.h"

#include <algorithm>
#include <cmath>

namespace heatsoak {
namespace {

Wrench operator-(const Wrench& a, const Wrench& b) { return {a.x_N - b.x_N, a.y_N - b.y_N, a.yaw_Nm - b.yaw_Nm}; }

/// Drag of rollers that do not slide.
PerWheel roller_drags_N(const BodyConfig& body, const PerWheel& lateral_m_per_s, const PerWheel& normal_N) {
  PerWheel drag_N{};
  for (int i = 0; i < body.kinematics.wheel_count; ++i) {
    drag_N[i] = contact_ratios(body.traction, 0.0, lateral_m_per_s[i]).lateral_ratio * normal_N[i];
  }
  return drag_N;
}

/// Shares κ of the acceleration in 0 … 1 that a contact can pass on; low > high where there are none.
struct Shares {
  double low = 0.0;
  double high = 1.0;
};

/// |rest + κ·part| ≤ limit.
Shares possible_shares(double rest_N, double part_N, double limit_N) {
  if (part_N == 0.0) {
    return std::abs(rest_N) <= limit_N ? Shares{} : Shares{1.0, 0.0};
  }
  const double one = (limit_N - rest_N) / part_N;
  const double other = (-limit_N - rest_N) / part_N;
  return {std::max(std::min(one, other), 0.0), std::min(std::max(one, other), 1.0)};
}

/// What is asked of the contacts: for drag and push alone, and for the acceleration on top.
struct Demand {
  Wrench acceleration;
  PerWheel rest_N{};
  PerWheel part_N{};
  PerWheel limit_N{};
};

Demand demand_on_contacts(const BodyConfig& body, const BodyMotion& motion, WheelDemands& out) {
  Demand demand;
  demand.acceleration = wrench_of_acceleration(body, motion.velocity.yaw_rad_per_s, motion.acceleration);
  const NormalLoads loads =
      normal_loads(body.weight, load_moment(body.weight, demand.acceleration - motion.external, motion.external, motion.external_height_m));
  out.normal_force_N = loads.force_N;
  out.lifted = loads.lifted;
  Wrench rest = Wrench{} - motion.external;
  if (body.traction.roller_drag_ratio > 0.0) {
    const PerWheel drag_N = roller_drags_N(body, lateral_speeds_m_per_s(body.kinematics, motion.velocity), loads.force_N);
    rest = rest - wrench_of_lateral_forces(body.kinematics, drag_N);
  }
  demand.rest_N = rolling_forces_N(body.kinematics, rest);
  demand.part_N = rolling_forces_N(body.kinematics, demand.acceleration);
  const double mu = body.traction.traction_ratio;
  const double c = body.traction.roller_drag_ratio;
  const double grip_ratio = std::sqrt(std::max(mu * mu - c * c, 0.0));
  for (int i = 0; i < body.kinematics.wheel_count; ++i) {
    demand.limit_N[i] = grip_ratio * loads.force_N[i];
    const double demanded_N = std::abs(demand.rest_N[i] + demand.part_N[i]);
    out.traction_use_ratio[i] = demanded_N == 0.0 ? 0.0 : demanded_N / demand.limit_N[i];
  }
  return demand;
}

/// Scales the acceleration to what the contacts pass on, or lets them slide.
void deliver(const BodyConfig& body, const BodyMotion& motion, const Demand& demand, WheelDemands& out) {
  Shares shares;
  for (int i = 0; i < body.kinematics.wheel_count; ++i) {
    const Shares of_wheel = possible_shares(demand.rest_N[i], demand.part_N[i], demand.limit_N[i]);
    shares = {std::max(shares.low, of_wheel.low), std::min(shares.high, of_wheel.high)};
  }
  const bool slides = shares.low > shares.high;
  const double share = slides ? 0.0 : shares.high;
  for (int i = 0; i < body.kinematics.wheel_count; ++i) {
    out.rolling_force_N[i] = slides ? std::clamp(demand.rest_N[i] + demand.part_N[i], -demand.limit_N[i], demand.limit_N[i])
                                    : demand.rest_N[i] + share * demand.part_N[i];
  }
  out.achievable = motion.acceleration;
  out.transmitted_share = share;
  if (share < 1.0) {
    PerWheel missing_N{};
    for (int i = 0; i < body.kinematics.wheel_count; ++i) {
      missing_N[i] = demand.rest_N[i] + demand.part_N[i] - out.rolling_force_N[i];
    }
    out.untransmitted = wrench_of_rolling_forces(body.kinematics, missing_N);
    out.achievable = acceleration_of_wrench(body, motion.velocity.yaw_rad_per_s, demand.acceleration - out.untransmitted);
  }
}

}  // namespace

BodyMotion local_motion(const BodyConfig& body, const Pose& pose, const BodyVelocity& velocity_global,
                        const BodyAcceleration& acceleration_global) {
  return {to_local(velocity_global, pose.yaw_rad), to_local(acceleration_global, pose.yaw_rad), {}, body.weight.center_of_gravity_height_m};
}

WheelDemands inverse_dynamics(const BodyConfig& body, const BodyMotion& motion) {
  WheelDemands out;
  out.speed_rad_per_s = wheel_speeds_rad_per_s(body.kinematics, motion.velocity);
  const Demand demand = demand_on_contacts(body, motion, out);
  deliver(body, motion, demand, out);
  const BodyAcceleration rates = rates_from_acceleration(motion.velocity, out.achievable);
  const PerWheel rim_m_per_s2 = rolling_speeds_m_per_s(body.kinematics, {rates.x_m_per_s2, rates.y_m_per_s2, rates.yaw_rad_per_s2});
  const PerWheel friction_Nm = friction_torques_Nm(body.friction, body.kinematics, motion.velocity, out.speed_rad_per_s);
  const double radius_m = body.kinematics.wheel_radius_m;
  for (int i = 0; i < body.kinematics.wheel_count; ++i) {
    const double ground_Nm = out.rolling_force_N[i] * radius_m;
    out.torque_Nm[i] = ground_Nm +
                       transmission_loss_Nm(body.rolling_efficiency, ground_Nm, out.speed_rad_per_s[i], body.friction.smoothing_rad_per_s) +
                       friction_Nm[i] + body.wheel_inertia_kg_m2 * rim_m_per_s2[i] / radius_m;
  }
  return out;
}

}  // namespace heatsoak
