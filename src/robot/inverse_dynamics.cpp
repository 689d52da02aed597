#include "robot/inverse_dynamics.h"

#include <algorithm>
#include <cmath>

#include "robot/wheel_laws.h"

namespace heatsoak::robot {
namespace {

Wrench operator-(const Wrench& a, const Wrench& b) { return {a.x_N - b.x_N, a.y_N - b.y_N, a.yaw_Nm - b.yaw_Nm}; }

/// Returns the roller drag along each axle without slip.
PerWheel roller_drags_N(const BodyConfig& body, const PerWheel& lateral_m_per_s, const PerWheel& normal_N) {
  PerWheel drag_N{};
  for (int i = 0; i < body.kinematics.wheel_count; ++i) {
    drag_N[i] = contact_ratios(body.traction, 0.0, lateral_m_per_s[i]).lateral_ratio * normal_N[i];
  }
  return drag_N;
}

/// Returns the rolling speed of every contact, which rolling_speeds_m_per_s() calculates wheel by wheel.
Wheels rolling_m_per_s(const WheelArrays& wheels, double x_m_per_s, double y_m_per_s, double yaw_rad_per_s) {
  return wheels.rolling_x_share * x_m_per_s + wheels.rolling_y_share * y_m_per_s + wheels.arm_m * yaw_rad_per_s;
}

/// Returns the rolling force of every wheel for a wrench, which rolling_forces_N() calculates wheel by wheel.
Wheels rolling_of_wrench_N(const Kinematics& kinematics, const Wrench& local) {
  return as_wheels(kinematics.inverse_x_factor) * local.x_N + as_wheels(kinematics.inverse_y_factor) * local.y_N +
         as_wheels(kinematics.inverse_yaw_per_m) * local.yaw_Nm;
}

/// Rolling forces demanded from the contacts: rest_N for drag and push alone, part_N for the acceleration; and their limits.
struct Demand {
  Wrench acceleration;
  Wheels rest_N;
  Wheels part_N;
  Wheels limit_N;
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
  demand.rest_N = rolling_of_wrench_N(body.kinematics, rest);
  demand.part_N = rolling_of_wrench_N(body.kinematics, demand.acceleration);
  const double mu = body.traction.traction_ratio;
  const double c = body.traction.roller_drag_ratio;
  demand.limit_N = std::sqrt(std::max(mu * mu - c * c, 0.0)) * as_wheels(loads.force_N);
  return demand;
}

/// Empty if low > high.
struct Interval {
  double low = 0.0;
  double high = 0.0;

  /// Restricts the interval to slope·x ≤ bound. A small tolerance is added, because wheels without load give coinciding bounds.
  void keep(double slope, double exact_bound) {
    const double bound = exact_bound + 1e-9;
    if (slope > 0.0) {
      high = std::min(high, bound / slope);
    } else if (slope < 0.0) {
      low = std::max(low, bound / slope);
    } else if (bound < 0.0) {
      low = high + 1.0;
    }
  }
};

/// A wheel with a smaller inner_share takes no part in the inner forces.
constexpr double kNoPart = 1e-9;

/// Returns the shares κ in 0 to 1 of the acceleration for which some inner force λ keeps every contact within its limit:
/// |rest_i + κ·part_i + λ·n_i| ≤ limit_i. Each wheel bounds λ from both sides; λ exists if every lower bound is below every upper bound.
/// These conditions are linear in κ.
Interval possible_shares(const Kinematics& kinematics, const Demand& demand) {
  Interval shares{0.0, 1.0};
  for (int i = 0; i < kinematics.wheel_count; ++i) {
    const double n_i = kinematics.inner_share[i];
    if (std::abs(n_i) < kNoPart) {
      shares.keep(demand.part_N[i], demand.limit_N[i] - demand.rest_N[i]);
      shares.keep(-demand.part_N[i], demand.limit_N[i] + demand.rest_N[i]);
      continue;
    }
    for (int j = 0; j < kinematics.wheel_count; ++j) {
      const double n_j = kinematics.inner_share[j];
      if (std::abs(n_j) >= kNoPart) {
        shares.keep(demand.part_N[j] / n_j - demand.part_N[i] / n_i, demand.limit_N[j] / std::abs(n_j) + demand.limit_N[i] / std::abs(n_i) +
                                                                         demand.rest_N[i] / n_i - demand.rest_N[j] / n_j);
      }
    }
  }
  return shares;
}

/// Returns whether the demand is within every limit without inner forces. This common case is checked first to save time.
bool grips(const Demand& demand) { return ((demand.rest_N + demand.part_N).abs() <= demand.limit_N).all(); }

/// Returns the smallest inner force that keeps the contacts within their limits at this share of the acceleration.
double inner_force_N(const Kinematics& kinematics, const Demand& demand, double share) {
  double low_N = -1e300;
  double high_N = 1e300;
  for (int i = 0; i < kinematics.wheel_count; ++i) {
    const double n = kinematics.inner_share[i];
    if (std::abs(n) >= kNoPart) {
      const double middle_N = -(demand.rest_N[i] + share * demand.part_N[i]) / n;
      low_N = std::max(low_N, middle_N - demand.limit_N[i] / std::abs(n));
      high_N = std::min(high_N, middle_N + demand.limit_N[i] / std::abs(n));
    }
  }
  return low_N <= high_N ? std::clamp(0.0, low_N, high_N) : 0.5 * (low_N + high_N);
}

/// Distributes the forces: adds inner forces, then scales the acceleration down, then lets the contacts slide. Returns the transmitted
/// forces.
Wheels deliver(const BodyConfig& body, const BodyMotion& motion, const Demand& demand, WheelDemands& out) {
  const bool all_grip = grips(demand);
  const Interval shares = all_grip ? Interval{0.0, 1.0} : possible_shares(body.kinematics, demand);
  const bool slides = shares.low > shares.high;
  const double share = slides ? 0.0 : shares.high;
  const double inner_N = all_grip ? 0.0 : inner_force_N(body.kinematics, demand, slides ? 1.0 : share);
  const Wheels shifted_N = inner_N * as_wheels(body.kinematics.inner_share);
  const Wheels wanted_N = demand.rest_N + demand.part_N + shifted_N;
  const Wheels rolling_N =
      slides ? Wheels(wanted_N.max(-demand.limit_N).min(demand.limit_N)) : Wheels(demand.rest_N + share * demand.part_N + shifted_N);
  as_wheels(out.rolling_force_N) = rolling_N;
  as_wheels(out.traction_use_ratio) = (wanted_N == 0.0).select(0.0, wanted_N.abs() / demand.limit_N);
  out.achievable = motion.acceleration;
  out.transmitted_share = share;
  if (share < 1.0) {
    out.untransmitted = wrench_of_rolling_forces(body.kinematics, per_wheel(wanted_N - rolling_N));
    out.achievable = acceleration_of_wrench(body, motion.velocity.yaw_rad_per_s, demand.acceleration - out.untransmitted);
  }
  return rolling_N;
}

}  // namespace

FieldAxis field_axis(double yaw_rad) {
  const BodyVelocity axis = to_local(BodyVelocity{1.0, 0.0, 0.0}, yaw_rad);
  return {axis.x_m_per_s, axis.y_m_per_s};
}

BodyMotion local_motion(const BodyConfig& body, const Pose& pose, const BodyVelocity& velocity_global,
                        const BodyAcceleration& acceleration_global) {
  return local_motion(body, field_axis(pose.yaw_rad), velocity_global, acceleration_global);
}

BodyMotion local_motion(const BodyConfig& body, const FieldAxis& axis, const BodyVelocity& velocity_global,
                        const BodyAcceleration& acceleration_global) {
  const auto along = [&](double x, double y) { return x * axis.x_share - y * axis.y_share; };
  const auto across = [&](double x, double y) { return x * axis.y_share + y * axis.x_share; };
  const auto& [v_x, v_y, yaw_rate] = velocity_global;
  const auto& [a_x, a_y, yaw_acceleration] = acceleration_global;
  return {{along(v_x, v_y), across(v_x, v_y), yaw_rate},
          {along(a_x, a_y), across(a_x, a_y), yaw_acceleration},
          {},
          body.weight.center_of_gravity_height_m};
}

WheelDemands inverse_dynamics(const BodyConfig& body, const BodyMotion& motion) {
  WheelDemands out;
  const WheelArrays wheels = wheel_arrays(body.kinematics);
  const double radius_m = body.kinematics.wheel_radius_m;
  const BodyVelocity& velocity = motion.velocity;
  const Wheels speed_rad_per_s = rolling_m_per_s(wheels, velocity.x_m_per_s, velocity.y_m_per_s, velocity.yaw_rad_per_s) / radius_m;
  as_wheels(out.speed_rad_per_s) = speed_rad_per_s;
  const Demand demand = demand_on_contacts(body, motion, out);
  const Wheels ground_Nm = deliver(body, motion, demand, out) * radius_m;
  const BodyAcceleration rates = rates_from_acceleration(velocity, out.achievable);
  const Wheels rim_m_per_s2 = rolling_m_per_s(wheels, rates.x_m_per_s2, rates.y_m_per_s2, rates.yaw_rad_per_s2);
  const Wheels sign = smooth_sign(speed_rad_per_s, body.friction.smoothing_rad_per_s);
  const Wheels loss_Nm = loss_torque_Nm(1.0 / body.rolling_efficiency - 1.0, 1.0 - body.rolling_efficiency, ground_Nm, sign);
  const Wheels friction_Nm = friction_torque_Nm(body.friction, dry_friction_Nm(body.friction, wheels, velocity), sign, speed_rad_per_s);
  as_wheels(out.torque_Nm) = ground_Nm + loss_Nm + friction_Nm + body.wheel_inertia_kg_m2 * rim_m_per_s2 / radius_m;
  return out;
}

double largest_push_N(const BodyConfig& body, double direction_rad, double height_m) {
  const auto holds = [&](double force_N) {
    BodyMotion motion;
    motion.external = {-force_N * std::cos(direction_rad), -force_N * std::sin(direction_rad), 0.0};
    motion.external_height_m = height_m;
    WheelDemands out;
    const Demand demand = demand_on_contacts(body, motion, out);
    const Interval shares = possible_shares(body.kinematics, demand);
    return shares.low <= shares.high;
  };
  // The forces without sliding are an interval from 0; bisection finds its upper end.
  double holds_N = 0.0;
  double slides_N = body.traction.traction_ratio * body.weight.mass_kg * kGravity_m_per_s2;
  constexpr int kHalvings = 40;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle_N = 0.5 * (holds_N + slides_N);
    (holds(middle_N) ? holds_N : slides_N) = middle_N;
  }
  return holds_N;
}

}  // namespace heatsoak::robot
