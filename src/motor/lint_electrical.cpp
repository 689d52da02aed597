// Checks of electrical and mechanical values that follow from one another.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "motor/lint_checks.h"

namespace heatsoak::motor::lint_checks {
namespace {

/// Rounding to three digits is ±0.5 % if the number begins with 1. Two values give 1 %, and unit conversion by the manufacturer adds
/// another digit. On maxon pages the product is 0.996 to 1.001.
constexpr double kConstantsTolerance = 0.015;
/// A convention must explain the factor at least this well; the two closest conventions are 4.5 % apart.
constexpr double kConventionTolerance = 0.02;
/// R, J, K_t² and the listed value, each with three digits: 5 × 0.5 % at worst, 2 % very likely; found ≤ 0.4 %.
constexpr double kProductTolerance = 0.02;
/// U/R and K_t·U/R: two or three values of three digits; found ≤ 0.7 % and ≤ 0.5 %.
constexpr double kStallTolerance = 0.015;
/// The 43.5 mm pages print the stall current in whole amperes, and 25.48 A as 26 A.
constexpr double kWholeAmperes_A = 0.6;
/// Rounding cannot explain a stall torque below this share of K_t·U/R; with saturation the share was 0.37 and 0.47.
constexpr double kLooksSaturated = 0.8;
/// motors.yaml: k_n(U − I_0 R) over the listed speed is 1.0008 to 1.0212, because commutation needs voltage too; plus ±1 % of rounding.
constexpr Bounds kNoLoadSpeed{0.99, 1.03};
/// (1 − √(I_0 R/U))² is the best efficiency of the linear model. Only rounding exceeds it (whole percent: 0.6 %). Losses that grow with
/// speed lower it by up to 5.6 % on known sheets (ECX FLAT 42 M).
constexpr Bounds kEfficiency{0.9, 1.015};

/// A mistaken convention: torque constant in that convention divided by the one per DC ampere.
struct Convention {
  double factor;
  LintWords meaning;
};
constexpr double kPeakPhase = std::numbers::sqrt3 * std::numbers::pi / 6.0;   // 0.907, per peak phase ampere
constexpr double kPhaseEmf = std::numbers::pi / (3.0 * std::numbers::sqrt3);  // 1/1.654, peak EMF of a phase
constexpr double kSqrt2 = std::numbers::sqrt2;
constexpr double kSqrt3 = std::numbers::sqrt3;
constexpr std::array kConventions = {
    Convention{kPhaseEmf, LintWords::emf_peak_of_phase},
    Convention{kPhaseEmf / kSqrt2, LintWords::emf_rms_of_phase},
    Convention{kPhaseEmf * kSqrt3 / kSqrt2, LintWords::emf_rms_between_terminals},
    Convention{kPhaseEmf * kSqrt3, LintWords::emf_peak_between_terminals},
    Convention{kPeakPhase, LintWords::per_phase_peak},
    Convention{kPeakPhase * kSqrt2, LintWords::per_phase_rms},
    Convention{1.0 / kPeakPhase, LintWords::declared_per_phase_peak},
    Convention{1.0 / (kPeakPhase * kSqrt2), LintWords::declared_per_phase_rms},
    Convention{kSqrt3, LintWords::terminals_over_phase},
    Convention{1.0 / kSqrt3, LintWords::phase_over_terminals},
    Convention{2.0 / kSqrt3, LintWords::sinusoidal_current},
    Convention{kSqrt3 / 2.0, LintWords::sinusoidal_current_inverse},
    Convention{kSqrt2, LintWords::peak_over_rms},
    Convention{1.0 / kSqrt2, LintWords::rms_over_peak},
    Convention{2.0, LintWords::one_phase_of_two},
    Convention{0.5, LintWords::two_phases_of_one},
};

LintClause explanation(double factor) {
  const auto distance = [&](const Convention& c) { return std::abs(factor / c.factor - 1.0); };
  const auto& nearest = *std::ranges::min_element(kConventions, {}, distance);
  if (distance(nearest) > kConventionTolerance) {
    return {LintWords::no_convention};
  }
  return LintClause{LintWords::contradictory_conventions, {LintClause{nearest.meaning}}};
}

/// Returns advice. A given no-load speed decides which of the two constants is wrong.
LintClause verdict_on_constants(const MotorValues& v) {
  const double emf_V = v.nominal_voltage_V - v.no_load_current_A * v.terminal_resistance_ohm;
  const double no_load_rad_per_s = plain(v.no_load_speed_rad_per_s);
  const bool speed_fits = !kNoLoadSpeed.excludes(plain(v.speed_constant_rad_per_s_per_V) * emf_V / no_load_rad_per_s);
  const bool torque_fits = !kNoLoadSpeed.excludes(emf_V / v.torque_constant_Nm_per_A / no_load_rad_per_s);
  LintClause torque_verdict = explanation(v.torque_constant_Nm_per_A * plain(v.speed_constant_rad_per_s_per_V));
  if (std::isnan(no_load_rad_per_s) || speed_fits == torque_fits) {
    return torque_verdict;
  }
  if (torque_fits) {
    return LintClause{LintWords::speed_constant_is_wrong,
                      {shown_speed(no_load_rad_per_s), shown_speed_constant(1.0 / v.torque_constant_Nm_per_A)}};
  }
  return LintClause{LintWords::speed_constant_is_right, {shown_speed(no_load_rad_per_s), torque_verdict}};
}

/// Returns a hint if a quantity proportional to the resistance is off by the factor 2 between one phase and two.
LintClause resistance_hint(double found_over_listed) {
  if (std::abs(found_over_listed / 0.5 - 1.0) < kConventionTolerance) {
    return {LintWords::resistance_is_of_one_phase};
  }
  if (std::abs(found_over_listed / 2.0 - 1.0) < kConventionTolerance) {
    return {LintWords::resistance_is_between_terminals};
  }
  return {LintWords::check_resistance};
}

Bounds around_one(double tolerance) { return {1.0 - tolerance, 1.0 + tolerance}; }

double gradient_rad_per_s_per_Nm(const MotorValues& v) {
  return v.terminal_resistance_ohm / (v.torque_constant_Nm_per_A * v.torque_constant_Nm_per_A);
}

bool is_whole(double value) { return std::abs(value - std::round(value)) < 1e-9; }

}  // namespace

void constants(const Motor& motor, Findings& findings) {
  const MotorValues& v = motor.nominal;
  const double product = v.torque_constant_Nm_per_A * plain(v.speed_constant_rad_per_s_per_V);
  if (around_one(kConstantsTolerance).excludes(product)) {
    findings.error("torque_constant", LintClause{LintWords::constants_product,
                                                 {shown_torque_constant(v.torque_constant_Nm_per_A),
                                                  shown_speed_constant(plain(v.speed_constant_rad_per_s_per_V)), LintNumber{product, 3},
                                                  verdict_on_constants(v)}});
  }
}

void mechanical_time_constant(const Motor& motor, Findings& findings) {
  const MotorValues& v = motor.nominal;
  const double expected_s = gradient_rad_per_s_per_Nm(v) * plain(v.rotor_inertia_kg_m2);
  const double ratio = expected_s / plain(v.mechanical_time_constant_s);
  if (around_one(kProductTolerance).excludes(ratio)) {
    findings.error("mechanical_time_constant", LintClause{LintWords::mechanical_time_constant,
                                                          {shown(plain(v.mechanical_time_constant_s) * 1e3, "ms"),
                                                           shown(expected_s * 1e3, "ms"), shown(v.terminal_resistance_ohm, "ohm"),
                                                           shown_inertia(plain(v.rotor_inertia_kg_m2)), resistance_hint(ratio)}});
  }
}

void speed_torque_gradient(const Motor& motor, Findings& findings) {
  const MotorValues& v = motor.nominal;
  const double ratio = gradient_rad_per_s_per_Nm(v) / plain(v.speed_torque_gradient_rad_per_s_per_Nm);
  if (around_one(kProductTolerance).excludes(ratio)) {
    findings.error(
        "speed_torque_gradient",
        LintClause{LintWords::speed_torque_gradient,
                   {shown_gradient(plain(v.speed_torque_gradient_rad_per_s_per_Nm)), shown_gradient(gradient_rad_per_s_per_Nm(v)),
                    shown(v.terminal_resistance_ohm, "ohm"), shown_torque_constant(v.torque_constant_Nm_per_A), resistance_hint(ratio)}});
  }
}

void stall_current(const Motor& motor, Findings& findings) {
  const MotorValues& v = motor.nominal;
  const double expected_A = v.nominal_voltage_V / v.terminal_resistance_ohm;
  const double rounding_A = is_whole(plain(v.stall_current_A)) ? kWholeAmperes_A : 0.0;
  const double allowed_A = std::max(rounding_A, kStallTolerance * expected_A);
  if (std::abs(plain(v.stall_current_A) - expected_A) > allowed_A) {
    findings.error("stall_current", LintClause{LintWords::stall_current,
                                               {shown(plain(v.stall_current_A), "A"), shown(v.nominal_voltage_V, "V"),
                                                shown(v.terminal_resistance_ohm, "ohm"), shown(expected_A, "A"), shown(allowed_A, "A"),
                                                resistance_hint(plain(v.stall_current_A) / expected_A)}});
  }
}

void stall_torque(const Motor& motor, Findings& findings) {
  const MotorValues& v = motor.nominal;
  const double linear_Nm = v.torque_constant_Nm_per_A * v.nominal_voltage_V / v.terminal_resistance_ohm;
  const double ratio = plain(v.stall_torque_Nm) / linear_Nm;
  const LintClause found{LintWords::stall_torque, {shown_torque(plain(v.stall_torque_Nm)), shown_torque(linear_Nm)}};
  if (motor.stall_includes_saturation) {
    if (ratio >= 1.0 - kStallTolerance) {
      findings.error("stall_torque", LintClause{LintWords::stall_torque_without_saturation, {found}});
    }
  } else if (around_one(kStallTolerance).excludes(ratio) &&
             std::abs(plain(v.stall_torque_Nm) / (v.torque_constant_Nm_per_A * plain(v.stall_current_A)) - 1.0) < kStallTolerance) {
    // Stall torque and stall current are consistent, so there is no saturation.
    findings.error("stall_torque", LintClause{LintWords::stall_torque_differs, {found, resistance_hint(ratio)}});
  } else if (ratio < kLooksSaturated) {
    findings.error("stall_torque", LintClause{LintWords::stall_torque_looks_saturated, {found}});
  } else if (around_one(kStallTolerance).excludes(ratio)) {
    findings.error("stall_torque", LintClause{LintWords::stall_torque_too_large, {found}});
  }
}

void no_load_speed(const Motor& motor, Findings& findings) {
  const MotorValues& v = motor.nominal;
  const bool has_speed_constant = v.speed_constant_rad_per_s_per_V.has_value();
  const double constant_rad_per_s_per_V = has_speed_constant ? plain(v.speed_constant_rad_per_s_per_V) : 1.0 / v.torque_constant_Nm_per_A;
  const double expected_rad_per_s = constant_rad_per_s_per_V * (v.nominal_voltage_V - v.no_load_current_A * v.terminal_resistance_ohm);
  if (kNoLoadSpeed.excludes(expected_rad_per_s / plain(v.no_load_speed_rad_per_s))) {
    findings.error("no_load_speed",
                   LintClause{LintWords::no_load_speed,
                              {shown_speed(plain(v.no_load_speed_rad_per_s)), shown_speed_constant(constant_rad_per_s_per_V),
                               shown(v.nominal_voltage_V, "V"), shown_speed(expected_rad_per_s),
                               LintClause{has_speed_constant ? LintWords::speed : LintWords::torque}}});
  }
}

void max_efficiency(const Motor& motor, Findings& findings) {
  const MotorValues& v = motor.nominal;
  const double root = std::sqrt(v.no_load_current_A * v.terminal_resistance_ohm / v.nominal_voltage_V);
  const double linear = (1.0 - root) * (1.0 - root);
  if (kEfficiency.excludes(plain(v.max_efficiency) / linear)) {
    findings.error("max_efficiency",
                   LintClause{LintWords::max_efficiency, {LintNumber{100.0 * plain(v.max_efficiency), 3}, LintNumber{100.0 * linear, 3}}});
  }
}

}  // namespace heatsoak::motor::lint_checks
