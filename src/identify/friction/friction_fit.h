// Damping and friction of every wheel from steady stretches: ETDP 2025, section 2.
#pragma once

#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "identify/friction/robust_fit.h"
#include "identify/friction/steady_parts.h"

namespace heatsoak {

// In steady motion  V_i = d_i·ω_i + f_i(θ),  f_i(θ) = a_i·sin(θ + φ_i) + b_i·sign(sin(θ + φ_i)).
// A wheel that should stand by geometry carries no information and is left out, as the paper does.
// The others turn the way their rolling direction says, so the sign is known; with S = sin(θ + φ_0), C = cos(θ + φ_0),
// φ_0 that of the rolling direction, the law is linear:  V = d·ω + A·S + B·C + b·sign S  (+ c·sign ω in rotation),
// a = ±√(A² + B²) and φ = φ_0 + atan(B/A). Fitted robustly over all parts of a wheel (robust_fit.h), legs as clusters
// where there are three per term. The interval of φ is Fieller's, cut off where a wheel that was seen turning one way would
// have to turn the other; there a and b are the best at that φ. Headings of two directions and their opposites do not
// tell φ: it is taken as φ_0, and the intervals cover what a and b are while φ lies within its doubt.
// Where what is left follows θ, the intervals are widened by what of it may hide in a and b (lack_of_fit.h).

/// An error of the law that follows the direction of travel (lack_of_fit.h).
struct LackOfFit {
  bool is_found = false;
  double left_V = std::numeric_limits<double>::quiet_NaN();     ///< root mean square over headings, beyond what does not repeat
  double repeats_V = std::numeric_limits<double>::quiet_NaN();  ///< standard deviation of what does not repeat; NaN: too few tell
  std::string repeats;                                          ///< what differs by it: "legs on one heading"
};

struct WheelFriction {
  Estimate damping_V_s_per_rad;                                ///< d
  Estimate sine_V;                                             ///< a
  Estimate constant_V;                                         ///< b
  Estimate phase_rad;                                          ///< φ, −π … π
  Estimate rotation_V;                                         ///< c; NaN without legs of rotation
  bool damping_is_given = false;                               ///< not found, taken from what is known of the robot
  double sine_per_damping_V = 0.0;                             ///< how much less a would be, were the given d twice as large
  bool phase_is_given = false;                                 ///< too few headings: that of the rolling direction
  bool phase_is_bounded = false;                               ///< beyond it the wheel would turn another way than it did
  double r2_ratio = std::numeric_limits<double>::quiet_NaN();  ///< share of the voltage's variance that is explained
  double rmse_V = std::numeric_limits<double>::quiet_NaN();
  LackOfFit lack;  ///< where it is found, the intervals are wider by it
  int parts_used = 0;
  int parts_standing = 0;  ///< the wheel should stand, or does
  int parts_outlying = 0;
  std::size_t rows_used = 0;
  std::string problem;  ///< why it was not learned; empty where it was

  [[nodiscard]] bool is_learned() const { return problem.empty(); }
  /// Of the driver in steady motion, the friction against the wheel's speed: near a heading on which the wheel stands the
  /// sign of sin(θ + φ) need not be that.
  [[nodiscard]] double voltage_V(double heading_rad, double wheel_speed_rad_per_s) const;
  /// f(θ)
  [[nodiscard]] double friction_V(double heading_rad) const;
};

/// One wheel on one heading: the straight line of voltage over speed (Figs. 4, 6, 8 of the paper).
struct HeadingLine {
  double heading_rad = 0.0;
  Estimate offset_V;             ///< at no speed: the static friction; intervals by the scatter of all headings
  Estimate damping_V_s_per_rad;  ///< NaN where the heading has one speed
};

struct FrictionFit {
  std::vector<WheelFriction> wheels;
  std::vector<std::vector<HeadingLine>> lines;  ///< per wheel
  int headings = 0;                             ///< distinct ones
  [[nodiscard]] bool is_learned() const;        ///< any wheel
};

struct FitSettings {
  bool use_return_legs = false;
  /// What damping is taken to be where all legs have one speed and it cannot be told from a; NaN: unknown.
  double known_damping_V_s_per_rad = std::numeric_limits<double>::quiet_NaN();
  /// How far φ, where it cannot be told, may lie off the rolling direction in 95 % of wheels: the nine fits of
  /// reports/friction lie 4.6° rms off it, times Student's quantile of nine.
  double phase_doubt_rad = 10.0 * std::numbers::pi / 180.0;
};

/// Headings within 2.5° of each other are one; which of them each part has, −1 for rotation and for legs that are not used.
std::vector<int> heading_numbers(const std::vector<SteadyPart>& parts, const FitSettings& settings);

FrictionFit fit_friction(const std::vector<SteadyPart>& parts, const Kinematics& kinematics, const FitSettings& settings);

/// Voltages that are expected before anything is learned.
using ExpectedVoltages = std::function<PerWheel(const SteadyPart&)>;

/// Every third heading is kept out of a fit and then foretold.
struct HeldOutError {
  int headings = 0;  ///< held out
  int all_headings = 0;
  double before_V = std::numeric_limits<double>::quiet_NaN();  ///< root mean square over wheels and parts
  double after_V = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> before_of_wheel_V;
  std::vector<double> after_of_wheel_V;
};
HeldOutError error_on_held_out_headings(const std::vector<SteadyPart>& parts, const Kinematics& kinematics, const FitSettings& settings,
                                        const ExpectedVoltages& before);

}  // namespace heatsoak
