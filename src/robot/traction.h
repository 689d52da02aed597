// Distribution of the robot's weight on its wheels, and the forces that a ground contact can transmit.
#pragma once

#include <cmath>

#include "robot/kinematics.h"

namespace heatsoak::robot {

inline constexpr double kGravity_m_per_s2 = 9.80665;

/// Mass on wheels. Four rigid wheels on a plane are statically indeterminate; equal springs under all wheels are assumed, so the loads are
/// a linear function of the contact position.
struct WeightConfig {
  double mass_kg = 0.0;
  double center_of_gravity_height_m = 0.0;
  double center_of_gravity_x_m = 0.0;  ///< in the local frame
  double center_of_gravity_y_m = 0.0;
  int wheel_count = 0;
  PerWheel contact_x_m{};
  PerWheel contact_y_m{};
  // N_i = level_i·(m·g) + along_x_i·S_x + along_y_i·S_y, with S = Σ N·(x, y)
  PerWheel level_share{};
  PerWheel along_x_per_m{};
  PerWheel along_y_per_m{};
};
/// Returns the weight with its centre of gravity at (`x_m`, `y_m`) in the local frame and `height_m` above the ground.
WeightConfig make_weight(const Kinematics& kinematics, double mass_kg, double height_m, double x_m, double y_m);

/// First moment of the loads, S = Σ N_i·(x_i, y_i).
struct LoadMoment {
  double x_Nm = 0.0;
  double y_Nm = 0.0;
};

/// Returns S = m·g·c − h·F + (h_e − h)·F_e. The ground force F acts below the centre of gravity (height h, offset c), so forward
/// acceleration loads the rear wheels. An external force F_e at the height h_e tips the robot the other way.
inline LoadMoment load_moment(const WeightConfig& weight, const Wrench& ground, const Wrench& external, double external_height_m) {
  const double weight_N = weight.mass_kg * kGravity_m_per_s2;
  const double height_m = weight.center_of_gravity_height_m;
  const double above_m = external_height_m - height_m;
  return {weight_N * weight.center_of_gravity_x_m - height_m * ground.x_N + above_m * external.x_N,
          weight_N * weight.center_of_gravity_y_m - height_m * ground.y_N + above_m * external.y_N};
}

/// Normal loads of the wheels.
struct NormalLoads {
  PerWheel force_N{};   ///< at least 0; the sum is the weight
  bool lifted = false;  ///< a wheel has left the ground, or the robot would tip over
};
/// Returns the loads. A wheel with a negative load gets 0, and the others carry the moment. If three or fewer wheels cannot carry it, the
/// robot tips over: the remaining loads are scaled to the weight.
NormalLoads normal_loads(const WeightConfig& weight, const LoadMoment& moment);

/// Forces of a contact with rubber rollers. Along the rolling direction
///   f_t = μ·N·s/√(s² + s_0²),                     s = r·ω − t·v (slip, > 0 drives):
/// linear creep at small slip, Coulomb friction at large slip. Along the axle
///   f_n = −c·N·u/√(u² + (κ·s)² + u_0²),           u = e·v:
/// the drag of the roller's bearing and rolling, c ≪ μ, as long as the contact does not slide. If it slides along the rolling direction,
/// friction opposes the whole sliding velocity and the roller stands still; only μ·N·u/s acts along the axle. The form above with κ = c/μ
/// is a smooth minimum of both. The two forces together stay within √(μ² + c²)·N.
/// Both forces dissipate energy: f_t·s ≥ 0 is slip heat, −f_n·u ≥ 0 is roller heat.
struct TractionConfig {
  double traction_ratio = 0.7;         ///< μ, largest rolling force per normal force
  double slip_speed_m_per_s = 0.05;    ///< s_0: slip at which 0.71 of μ is used
  double roller_drag_ratio = 0.0;      ///< c, drag along the axle per normal force
  double roller_speed_m_per_s = 0.01;  ///< u_0: speed over which the sign of u is smoothed
};

/// Returns the force per normal force and its derivative with respect to slip. S is double for one contact, Wheels for all.
template <class S>
struct ContactRatios {
  S rolling_ratio;
  S lateral_ratio;
  S rolling_slope_s_per_m;
};
template <class S>
ContactRatios<S> contact_ratios(const TractionConfig& traction, const S& slip_m_per_s, const S& lateral_m_per_s) {
  using std::sqrt;
  const double s_0_m_per_s = traction.slip_speed_m_per_s;
  const S per_root_s_per_m = 1.0 / sqrt(slip_m_per_s * slip_m_per_s + s_0_m_per_s * s_0_m_per_s);
  ContactRatios<S> ratios;
  ratios.rolling_ratio = traction.traction_ratio * slip_m_per_s * per_root_s_per_m;
  ratios.rolling_slope_s_per_m =
      traction.traction_ratio * s_0_m_per_s * s_0_m_per_s * (per_root_s_per_m * per_root_s_per_m * per_root_s_per_m);
  if (traction.roller_drag_ratio == 0.0) {
    ratios.lateral_ratio = 0.0 * lateral_m_per_s;
    return ratios;
  }
  const S sliding_m_per_s = traction.roller_drag_ratio / traction.traction_ratio * slip_m_per_s;
  const double u_0_m_per_s = traction.roller_speed_m_per_s;
  ratios.lateral_ratio = -traction.roller_drag_ratio * lateral_m_per_s /
                         sqrt(lateral_m_per_s * lateral_m_per_s + sliding_m_per_s * sliding_m_per_s + u_0_m_per_s * u_0_m_per_s);
  return ratios;
}

}  // namespace heatsoak::robot
