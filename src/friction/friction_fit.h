// Fits damping and friction of every wheel from steady segments (ETDP 2025, section 2).
#pragma once

#include <functional>
#include <numbers>
#include <optional>
#include <vector>

#include "friction/findings.h"
#include "friction/robust_fit.h"
#include "friction/steady_parts.h"

namespace heatsoak::friction {

// Law of a wheel in steady motion:  V_i = d_i·ω_i + f_i(θ),  f_i(θ) = a_i·sin(θ + φ_i) + b_i·sign(sin(θ + φ_i)).
// Parts in which the wheel should stand by geometry carry no information and are omitted, as in the paper. In the others the wheel turns in
// its rolling direction, so the sign is known. Let φ_0 be the phase of the rolling direction, S = sin(θ + φ_0) and C = cos(θ + φ_0). Then
// the law is linear:  V = d·ω + A·S + B·C + b·sign S  (+ c·sign ω in rotation). Its solution gives a = ±√(A² + B²), φ = φ_0 + atan(B/A).
// The fit is robust over all parts of a wheel (robust_fit.h). Legs are clusters if there are three per term.
// The interval of φ is Fieller's. It ends at the φ beyond which the law would turn the wheel against its measured sense. A φ there is kept
// at this end, and a and b are the best ones for it.
// Headings in only two directions and their opposites do not determine φ. Then φ = φ_0, and the intervals of a and b cover its uncertainty.
// If the residuals depend on θ, the intervals are widened by the part of that error that a and b may contain (lack_of_fit.h).

/// Model error that depends on the direction of travel (lack_of_fit.h).
struct LackOfFit {
  bool is_found = false;
  std::optional<double> left_V = {};               ///< RMS over headings, without the scatter of repeats; empty: too few repeats
  std::optional<double> repeats_V = {};            ///< standard deviation of the scatter of repeats; empty: too few repeats
  Repeats repeats = Repeats::legs_on_one_heading;  ///< kind of repeats, if `repeats_V` is known
};

struct WheelFriction {
  // All of them are empty if the wheel was not fitted.
  std::optional<Estimate> damping_V_s_per_rad;  ///< d
  std::optional<Estimate> sine_V;               ///< a; empty if the legs only turn on the spot, like b and φ
  std::optional<Estimate> constant_V;           ///< b
  std::optional<Estimate> phase_rad;            ///< φ, −π to π
  std::optional<Estimate> rotation_V;           ///< c; empty without rotation legs
  bool damping_is_given = false;                ///< true: d was not fitted but taken from FitSettings
  double sine_per_damping_V = 0.0;              ///< decrease of a if the given d were twice as large
  bool phase_is_given = false;                  ///< true: too few headings, so φ is that of the rolling direction
  bool phase_is_bounded = false;                ///< true: φ is at its limit; beyond it the wheel would turn the other way than measured
  std::optional<double> r2_ratio = {};          ///< coefficient of determination of the voltage; empty if the voltage does not vary
  std::optional<double> rmse_V = {};            ///< empty if the wheel was not fitted
  LackOfFit lack;                               ///< if found, the intervals include it
  int parts_used = 0;
  int parts_standing = 0;  ///< parts in which the wheel should stand, or does
  int parts_outlying = 0;
  std::size_t rows_used = 0;
  std::optional<WheelProblem> problem;  ///< set if the wheel was not fitted

  [[nodiscard]] bool is_learned() const { return !problem.has_value(); }
  /// Voltage of the motor driver in steady motion. The friction always opposes the wheel's speed, even if sin(θ + φ) has another sign than
  /// the speed, as is possible near headings on which the wheel stands. Only for a wheel that has a, b and φ.
  [[nodiscard]] double voltage_V(double heading_rad, double wheel_speed_rad_per_s) const;
  /// Friction voltage f(θ). Only for a wheel that has a, b and φ.
  [[nodiscard]] double friction_V(double heading_rad) const;
};

/// Straight line of voltage over speed of one wheel on one heading (Figs. 4, 6, 8 of the paper).
struct HeadingLine {
  double heading_rad = 0.0;
  Estimate offset_V;                            ///< at zero speed, the static friction; its interval uses the scatter of all headings
  std::optional<Estimate> damping_V_s_per_rad;  ///< empty if the heading has only one speed
};

struct FrictionFit {
  std::vector<WheelFriction> wheels;
  std::vector<std::vector<HeadingLine>> lines;  ///< per wheel
  int headings = 0;                             ///< number of distinct headings
  [[nodiscard]] bool is_learned() const;        ///< true if any wheel was fitted
};

struct FitSettings {
  bool use_return_legs = false;
  /// Damping to use if all legs have one speed, so that d and a are indistinguishable.
  std::optional<double> known_damping_V_s_per_rad = {};
  /// Half width of the 95 % interval of φ about the rolling direction if the data do not determine φ. The nine fits of reports/friction
  /// deviate by 4.6° RMS; this is multiplied by Student's quantile for nine.
  double phase_uncertainty_rad = 10.0 * std::numbers::pi / 180.0;
};

/// Returns the heading number of each part, counted from 0; empty for rotation and for legs that are not used. Headings within 2.5° of each
/// other are one.
std::vector<std::optional<int>> heading_numbers(const std::vector<SteadyPart>& parts, const FitSettings& settings);

/// Fits every wheel. A wheel whose parts do not determine its terms gets a reason in WheelFriction::problem.
FrictionFit fit_friction(const std::vector<SteadyPart>& parts, const robot::Kinematics& kinematics, const FitSettings& settings);

/// Returns the voltages of all wheels that are expected before the fit.
using ExpectedVoltages = std::function<robot::PerWheel(const SteadyPart&)>;

/// Prediction errors on hold-out headings: every third heading is excluded from the fit and then predicted.
struct HeldOutError {
  int headings = 0;                     ///< number of hold-out headings
  int all_headings = 0;                 ///< number of all headings
  std::optional<double> before_V = {};  ///< RMS over wheels and parts, of the expected voltages
  std::optional<double> after_V = {};   ///< RMS over wheels and parts, of the fit
  std::vector<std::optional<double>> before_of_wheel_V;
  std::vector<std::optional<double>> after_of_wheel_V;
};
/// Returns the errors of a fit to the other headings, and those of `before`. An error is empty if it has no hold-out part, or no `before`.
HeldOutError error_on_held_out_headings(const std::vector<SteadyPart>& parts, const robot::Kinematics& kinematics,
                                        const FitSettings& settings, const ExpectedVoltages& before);

}  // namespace heatsoak::friction
