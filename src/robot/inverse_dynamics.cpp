#include "robot/inverse_dynamics.h"

#include <algorithm>
#include <cmath>

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

/// Rolling forces demanded from the contacts: rest_N for drag and push alone, part_N for the acceleration; and their limits.
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
  }
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
bool grips(const Kinematics& kinematics, const Demand& demand) {
  bool all = true;
  for (int i = 0; i < kinematics.wheel_count; ++i) {
    all = all && std::abs(demand.rest_N[i] + demand.part_N[i]) <= demand.limit_N[i];
  }
  return all;
}

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

/// Distributes the forces: adds inner forces, then scales the acceleration down, then lets the contacts slide.
void deliver(const BodyConfig& body, const BodyMotion& motion, const Demand& demand, WheelDemands& out) {
  const int count = body.kinematics.wheel_count;
  const Interval shares = grips(body.kinematics, demand) ? Interval{0.0, 1.0} : possible_shares(body.kinematics, demand);
  const bool slides = shares.low > shares.high;
  const double share = slides ? 0.0 : shares.high;
  const double inner_N = inner_force_N(body.kinematics, demand, slides ? 1.0 : share);
  PerWheel missing_N{};
  for (int i = 0; i < count; ++i) {
    const double shifted_N = inner_N * body.kinematics.inner_share[i];
    const double wanted_N = demand.rest_N[i] + demand.part_N[i] + shifted_N;
    out.rolling_force_N[i] =
        slides ? std::clamp(wanted_N, -demand.limit_N[i], demand.limit_N[i]) : demand.rest_N[i] + share * demand.part_N[i] + shifted_N;
    out.traction_use_ratio[i] = wanted_N == 0.0 ? 0.0 : std::abs(wanted_N) / demand.limit_N[i];
    missing_N[i] = wanted_N - out.rolling_force_N[i];
  }
  out.achievable = motion.acceleration;
  out.transmitted_share = share;
  if (share < 1.0) {
    out.untransmitted = wrench_of_rolling_forces(body.kinematics, missing_N);
    out.achievable = acceleration_of_wrench(body, motion.velocity.yaw_rad_per_s, demand.acceleration - out.untransmitted);
  }
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
