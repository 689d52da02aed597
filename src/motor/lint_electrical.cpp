// Checks of electrical and mechanical values that follow from one another.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/quantity.h"
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
  std::string_view meaning;
};
constexpr double kPeakPhase = std::numbers::sqrt3 * std::numbers::pi / 6.0;   // 0.907, per peak phase ampere
constexpr double kPhaseEmf = std::numbers::pi / (3.0 * std::numbers::sqrt3);  // 1/1.654, peak EMF of a phase
constexpr double kSqrt2 = std::numbers::sqrt2;
constexpr double kSqrt3 = std::numbers::sqrt3;
constexpr std::array kConventions = {
    Convention{kPhaseEmf, "the peak EMF of one phase (V s/rad); multiply it by sqrt(3)*3/pi = 1.654"},
    Convention{kPhaseEmf / kSqrt2, "the RMS EMF of one phase; multiply it by 2.339"},
    Convention{kPhaseEmf * kSqrt3 / kSqrt2, "the RMS EMF between terminals; multiply it by 1.35"},
    Convention{kPhaseEmf * kSqrt3, "the peak EMF between terminals; multiply it by 3/pi = 0.955"},
    Convention{kPeakPhase, "a torque constant per ampere of phase peak; set conventions.torque_constant = \"per_peak_phase_ampere\""},
    Convention{kPeakPhase * kSqrt2,
               "a torque constant per ampere of phase RMS; set conventions.torque_constant = \"per_rms_phase_ampere\""},
    Convention{1.0 / kPeakPhase,
               "a torque constant per DC ampere where the file declares per_peak_phase_ampere; set conventions.torque_constant = "
               "\"per_dc_ampere\""},
    Convention{1.0 / (kPeakPhase * kSqrt2),
               "a torque constant per DC ampere where the file declares per_rms_phase_ampere; set conventions.torque_constant = "
               "\"per_dc_ampere\""},
    Convention{kSqrt3, "sqrt(3) between phase and terminals; divide it by 1.732"},
    Convention{1.0 / kSqrt3, "sqrt(3) between terminals and phase; multiply it by 1.732"},
    Convention{2.0 / kSqrt3, "2/sqrt(3) between two conventions of sinusoidal current; divide it by 1.155"},
    Convention{kSqrt3 / 2.0, "sqrt(3)/2 between two conventions of sinusoidal current; multiply it by 1.155"},
    Convention{kSqrt2, "sqrt(2) between peak and RMS; divide it by 1.414"},
    Convention{1.0 / kSqrt2, "sqrt(2) between RMS and peak; multiply it by 1.414"},
    Convention{2.0, "2 between one phase and two in series; halve it"},
    Convention{0.5, "2 between two phases in series and one; double it"},
};

std::string explanation(double factor) {
  const auto distance = [&](const Convention& c) { return std::abs(factor / c.factor - 1.0); };
  const auto& nearest = *std::ranges::min_element(kConventions, {}, distance);
  if (distance(nearest) > kConventionTolerance) {
    return "no known convention explains this factor, so one of the two was misread or badly identified; take both from one sheet";
  }
  return fmt::format("these are contradictory conventions: the factor is that of {}", nearest.meaning);
}

/// Returns advice. A given no-load speed decides which of the two constants is wrong.
std::string verdict_on_constants(const MotorValues& v) {
  const double emf_V = v.nominal_voltage_V - v.no_load_current_A * v.terminal_resistance_ohm;
  const double no_load_rad_per_s = plain(v.no_load_speed_rad_per_s);
  const bool speed_fits = !kNoLoadSpeed.excludes(plain(v.speed_constant_rad_per_s_per_V) * emf_V / no_load_rad_per_s);
  const bool torque_fits = !kNoLoadSpeed.excludes(emf_V / v.torque_constant_Nm_per_A / no_load_rad_per_s);
  std::string torque_verdict = explanation(v.torque_constant_Nm_per_A * plain(v.speed_constant_rad_per_s_per_V));
  if (std::isnan(no_load_rad_per_s) || speed_fits == torque_fits) {
    return torque_verdict;
  }
  if (torque_fits) {
    return fmt::format(
        "the no-load speed of {} agrees with the torque constant, so the speed constant should be {}; take it from the sheet",
        shown_speed(no_load_rad_per_s), shown_speed_constant(1.0 / v.torque_constant_Nm_per_A));
  }
  return fmt::format("the no-load speed of {} agrees with the speed constant; {}", shown_speed(no_load_rad_per_s), torque_verdict);
}

/// Returns a hint if a quantity proportional to the resistance is off by the factor 2 between one phase and two.
std::string resistance_hint(double found_over_listed) {
  if (std::abs(found_over_listed / 0.5 - 1.0) < kConventionTolerance) {
    return "; the factor 2 means that the resistance is of one phase: set conventions.terminal_resistance = \"phase_to_star\"";
  }
  if (std::abs(found_over_listed / 2.0 - 1.0) < kConventionTolerance) {
    return "; the factor 2 means that the resistance was between terminals already: set conventions.terminal_resistance = "
           "\"between_terminals\"";
  }
  return "; check resistance, torque constant and their conventions";
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
    findings.error("torque_constant", fmt::format("torque constant {} times speed constant {} is {}, expected 1 within 1.5 %; {}",
                                                  shown_torque_constant(v.torque_constant_Nm_per_A),
                                                  shown_speed_constant(plain(v.speed_constant_rad_per_s_per_V)),
                                                  base::significant(product, 3), verdict_on_constants(v)));
  }
}

void mechanical_time_constant(const Motor& motor, Findings& findings) {
  const MotorValues& v = motor.nominal;
  const double expected_s = gradient_rad_per_s_per_Nm(v) * plain(v.rotor_inertia_kg_m2);
  const double ratio = expected_s / plain(v.mechanical_time_constant_s);
  if (around_one(kProductTolerance).excludes(ratio)) {
    findings.error("mechanical_time_constant", fmt::format("{} is listed, but R·J/K_t² is {} with {} and {}; expected within 2 %{}",
                                                           shown(plain(v.mechanical_time_constant_s) * 1e3, "ms"),
                                                           shown(expected_s * 1e3, "ms"), shown(v.terminal_resistance_ohm, "ohm"),
                                                           shown_inertia(plain(v.rotor_inertia_kg_m2)), resistance_hint(ratio)));
  }
}

void speed_torque_gradient(const Motor& motor, Findings& findings) {
  const MotorValues& v = motor.nominal;
  const double ratio = gradient_rad_per_s_per_Nm(v) / plain(v.speed_torque_gradient_rad_per_s_per_Nm);
  if (around_one(kProductTolerance).excludes(ratio)) {
    findings.error(
        "speed_torque_gradient",
        fmt::format("{} is listed, but R/K_t² is {} with {} and {}; expected within 2 %{}",
                    shown_gradient(plain(v.speed_torque_gradient_rad_per_s_per_Nm)), shown_gradient(gradient_rad_per_s_per_Nm(v)),
                    shown(v.terminal_resistance_ohm, "ohm"), shown_torque_constant(v.torque_constant_Nm_per_A), resistance_hint(ratio)));
  }
}

void stall_current(const Motor& motor, Findings& findings) {
  const MotorValues& v = motor.nominal;
  const double expected_A = v.nominal_voltage_V / v.terminal_resistance_ohm;
  const double rounding_A = is_whole(plain(v.stall_current_A)) ? kWholeAmperes_A : 0.0;
  const double allowed_A = std::max(rounding_A, kStallTolerance * expected_A);
  if (std::abs(plain(v.stall_current_A) - expected_A) > allowed_A) {
    findings.error("stall_current",
                   fmt::format("{} is listed, but {} through {} is {}; expected within {}{}", shown(plain(v.stall_current_A), "A"),
                               shown(v.nominal_voltage_V, "V"), shown(v.terminal_resistance_ohm, "ohm"), shown(expected_A, "A"),
                               shown(allowed_A, "A"), resistance_hint(plain(v.stall_current_A) / expected_A)));
  }
}

void stall_torque(const Motor& motor, Findings& findings) {
  const MotorValues& v = motor.nominal;
  const double linear_Nm = v.torque_constant_Nm_per_A * v.nominal_voltage_V / v.terminal_resistance_ohm;
  const double ratio = plain(v.stall_torque_Nm) / linear_Nm;
  const std::string found = fmt::format("{} is listed, K_t·U/R is {}", shown_torque(plain(v.stall_torque_Nm)), shown_torque(linear_Nm));
  if (motor.stall_includes_saturation) {
    if (ratio >= 1.0 - kStallTolerance) {
      findings.error("stall_torque", found +
                                         "; with saturation, which conventions.stall_includes_saturation declares, expected less; "
                                         "set it to false if the sheet's line is straight");
    }
  } else if (around_one(kStallTolerance).excludes(ratio) &&
             std::abs(plain(v.stall_torque_Nm) / (v.torque_constant_Nm_per_A * plain(v.stall_current_A)) - 1.0) < kStallTolerance) {
    // Stall torque and stall current are consistent, so there is no saturation.
    findings.error("stall_torque", found + ", expected the same within 1.5 %" + resistance_hint(ratio));
  } else if (ratio < kLooksSaturated) {
    findings.error("stall_torque", found +
                                       ", expected the same within 1.5 %; this looks like a torque with saturation: "
                                       "set conventions.stall_includes_saturation = true, or check torque constant and resistance");
  } else if (around_one(kStallTolerance).excludes(ratio)) {
    findings.error("stall_torque", found + ", expected the same within 1.5 %; check torque constant, resistance and their conventions");
  }
}

void no_load_speed(const Motor& motor, Findings& findings) {
  const MotorValues& v = motor.nominal;
  const bool has_speed_constant = v.speed_constant_rad_per_s_per_V.has_value();
  const double constant_rad_per_s_per_V = has_speed_constant ? plain(v.speed_constant_rad_per_s_per_V) : 1.0 / v.torque_constant_Nm_per_A;
  const double expected_rad_per_s = constant_rad_per_s_per_V * (v.nominal_voltage_V - v.no_load_current_A * v.terminal_resistance_ohm);
  if (kNoLoadSpeed.excludes(expected_rad_per_s / plain(v.no_load_speed_rad_per_s))) {
    findings.error("no_load_speed",
                   fmt::format("{} is listed, but {} and {} less I_0·R give {}; expected 0.99 to 1.03 times the listed speed; "
                               "check the {} constant and the voltage that the speed holds for",
                               shown_speed(plain(v.no_load_speed_rad_per_s)), shown_speed_constant(constant_rad_per_s_per_V),
                               shown(v.nominal_voltage_V, "V"), shown_speed(expected_rad_per_s), has_speed_constant ? "speed" : "torque"));
  }
}

void max_efficiency(const Motor& motor, Findings& findings) {
  const MotorValues& v = motor.nominal;
  const double root = std::sqrt(v.no_load_current_A * v.terminal_resistance_ohm / v.nominal_voltage_V);
  const double linear = (1.0 - root) * (1.0 - root);
  if (kEfficiency.excludes(plain(v.max_efficiency) / linear)) {
    findings.error("max_efficiency",
                   fmt::format("{} % is listed, but (1 - sqrt(I_0·R/U))² is {} %; expected 0.9 to 1.015 times that; "
                               "check no-load current and resistance",
                               base::significant(100.0 * plain(v.max_efficiency), 3), base::significant(100.0 * linear, 3)));
  }
}

}  // namespace heatsoak::motor::lint_checks
