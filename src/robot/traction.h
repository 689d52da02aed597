// How the robot's weight stands on its wheels, and what force a contact can pass on.
#pragma once

#include "robot/kinematics.h"

namespace heatsoak {

inline constexpr double kGravity_m_per_s2 = 9.80665;

/// Mass on wheels. Four stiff wheels on a plane leave one load open; equal springs under equal wheels settle it, so
/// the loads are a plane over the contact points.
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
WeightConfig make_weight(const Kinematics& kinematics, double mass_kg, double height_m, double x_m, double y_m);

/// First moment of the loads, S = Σ N_i·(x_i, y_i).
struct LoadMoment {
  double x_Nm = 0.0;
  double y_Nm = 0.0;
};

/// S = m·g·c − h·F + (h_e − h)·F_e: the ground's force F acts below the centre of gravity (height h, offset c), so
/// accelerating forward loads the rear wheels; a push F_e from outside at the height h_e tips the other way.
LoadMoment load_moment(const WeightConfig& weight, const Wrench& ground, const Wrench& external, double external_height_m);

struct NormalLoads {
  PerWheel force_N{};   ///< at least 0; the sum is the weight
  bool lifted = false;  ///< a wheel has left the ground, or the robot would tip over
};
/// A wheel that would have to pull on the ground has 0, and the others carry the moment; where three or fewer
/// cannot, the robot tips: the remaining loads are scaled to the weight.
NormalLoads normal_loads(const WeightConfig& weight, const LoadMoment& moment);

/// What a contact of rubber rollers passes on: along the rolling direction
///   f_t = μ·N·s/√(s² + s_0²),                     s = r·ω − t·v (slip, > 0 drives),
/// which is linear creep at small slip and Coulomb friction at large, and along the axle
///   f_n = −c·N·u/√(u² + (κ·s)² + u_0²),           u = e·v,
/// the drag of the roller's bearing and rolling, c ≪ μ, as long as the contact does not slide. Where it slides along
/// the rolling direction, its friction points against the whole sliding velocity and only μ·N·u/s of it along the axle,
/// so the roller stands still: the form above with κ = c/μ is the smooth lesser of both. The two forces stay within
/// √(μ² + c²)·N.
/// Both take energy only: f_t·s ≥ 0 is slip heat, −f_n·u ≥ 0 is roller heat.
struct TractionConfig {
  double traction_ratio = 0.7;         ///< μ, largest rolling force per normal force
  double slip_speed_m_per_s = 0.05;    ///< s_0: slip that uses 0.71 of it
  double roller_drag_ratio = 0.0;      ///< c, axle-wise drag per normal force
  double roller_speed_m_per_s = 0.01;  ///< u_0: where the sign of u is smoothed
};

/// Force per normal force, and its slope over the slip.
struct ContactRatios {
  double rolling_ratio = 0.0;
  double lateral_ratio = 0.0;
  double rolling_slope_s_per_m = 0.0;
};
ContactRatios contact_ratios(const TractionConfig& traction, double slip_m_per_s, double lateral_m_per_s);

}  // namespace heatsoak
