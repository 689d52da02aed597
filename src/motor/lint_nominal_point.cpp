// Checks of the nominal point: motor constants, energy balance and heat.
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <numbers>

#include "motor/datasheet_network.h"
#include "motor/lint_checks.h"
#include "thermal/steady_state.h"

namespace heatsoak::motor::lint_checks {
namespace {

/// motors.yaml: T_n/(K_t·I_n) is 0.98 to 1.09 on EC flat pages, because the listed current is the mean supply current during commutation.
/// Widened by about 0.1 on each side for the definitions of other manufacturers.
constexpr Bounds kNominalTorque{0.85, 1.2};
/// A peak torque has the same excess (found 1.07 and 1.10), but saturation may reduce it strongly (0.37 at stall).
constexpr Bounds kPeakTorque{0.2, 1.2};
/// Energy balance with the least possible loss, copper at 25 °C: only the rounding of four values remains.
constexpr double kPowerTolerance = 0.03;
/// Shaft power, hot copper loss and drag explain 0.93 to 1.03 of the input on known sheets. Too little means unexplained power. Too much
/// means a resistance that is too high; a sheet whose nominal point stays below the winding limit gives at most 4 % more.
constexpr Bounds kPowerExplained{0.85, 1.08};
/// Rounding of the nominal speed and of the line; known speeds lie between the two lines of the check.
constexpr double kSpeedTolerance = 0.03;
/// Commutation makes a resistance derived from the slowest nominal speed uncertain: ±30 % around 2.
constexpr Bounds kAboutTwo{1.4, 2.6};
/// motors.yaml: 0.946 to 1.045 on the 12 windings with full data; widened for other sheets.
constexpr Bounds kHeat{0.85, 1.10};
/// Range of those 12 with rounding. Outside it a value that the verdict depends on may be wrong: half a thermal resistance changes the
/// ratio by only 7 %.
constexpr Bounds kUsualHeat{0.935, 1.055};
/// motors.yaml: I_n over the current for copper loss alone is 0.73 to 0.985; plus ±10 %.
constexpr Bounds kCopperLimit{0.65, 1.05};

/// Returns the current in A that heats the winding exactly to its limit in the steady state; 0 if the other losses alone do. Uses the data
/// sheet network, because the nominal point of a sheet does not include effects that the file adds.
double limit_current_A(const Motor& motor, double speed_rad_per_s) {
  Motor sheet = motor;
  sheet.effects.clear();
  const thermal::Network network = datasheet_network(sheet, nominal_sample(sheet));
  const auto winding = static_cast<std::size_t>(network.node("winding"));
  const auto excess_K = [&](double current_A) {
    const std::optional<thermal::SteadyState> rest =
        thermal::steady_state(network, {current_A, speed_rad_per_s, speed_rad_per_s, kSheetAmbient_C});
    constexpr double kRunaway_K = 1e6;
    return rest ? rest->temperature_C[winding] - motor.nominal.winding_limit_C : kRunaway_K;
  };
  if (excess_K(0.0) >= 0.0) {
    return 0.0;
  }
  double too_much_A = 1.0;
  while (excess_K(too_much_A) < 0.0) {
    too_much_A *= 2.0;
  }
  constexpr int kBits = 30;
  return boost::math::tools::bisect(excess_K, 0.0, too_much_A, boost::math::tools::eps_tolerance<double>(kBits)).first;
}

LintFinding::Level level_of_heat(const Motor& motor) {
  return level_of_contradiction(
      motor, {"thermal_resistance_winding_stator", "thermal_resistance_stator_ambient", "winding_limit", "terminal_resistance",
              "torque_constant", "no_load_current", "nominal_torque", "nominal_speed", "nominal_current"});
}

/// Returns the largest voltage loss of commutation per ampere, in ohm: the overlap of a six-pulse bridge, (3/π)·ω_electric·L of one phase.
/// 0 if the file lacks inductance or pole pairs.
double commutation_ohm(const MotorValues& v) {
  const double overlap_ohm =
      3.0 / std::numbers::pi * plain(v.pole_pairs) * plain(v.nominal_speed_rad_per_s) * 0.5 * plain(v.terminal_inductance_H);
  return std::isnan(overlap_ohm) ? 0.0 : overlap_ohm;
}

}  // namespace

void nominal_current(const Motor& motor, Findings& findings) {
  const MotorValues& v = motor.nominal;
  if (v.no_load_current_A >= plain(v.nominal_current_A)) {
    findings.error("no_load_current", LintClause{LintWords::no_load_current_above_nominal,
                                                 {shown(v.no_load_current_A, "A"), shown(plain(v.nominal_current_A), "A")}});
  }
  const double linear_Nm = v.torque_constant_Nm_per_A * plain(v.nominal_current_A);
  if (kNominalTorque.excludes(plain(v.nominal_torque_Nm) / linear_Nm)) {
    findings.error(
        "nominal_current",
        LintClause{LintWords::nominal_torque_of_current,
                   {shown_torque(plain(v.nominal_torque_Nm)), LintNumber{plain(v.nominal_torque_Nm) / linear_Nm, 3},
                    shown_torque(linear_Nm), shown_torque_constant(v.torque_constant_Nm_per_A), shown(plain(v.nominal_current_A), "A")}});
  }
}

void peak_point(const Motor& motor, Findings& findings) {
  const MotorValues& v = motor.nominal;
  if (plain(v.peak_torque_Nm) < plain(v.nominal_torque_Nm)) {
    findings.error("peak_torque", LintClause{LintWords::peak_torque_below_nominal,
                                             {shown_torque(plain(v.peak_torque_Nm)), shown_torque(plain(v.nominal_torque_Nm))}});
  }
  if (plain(v.peak_current_A) < plain(v.nominal_current_A)) {
    findings.error("peak_current", LintClause{LintWords::peak_current_below_nominal,
                                              {shown(plain(v.peak_current_A), "A"), shown(plain(v.nominal_current_A), "A")}});
  }
  const double linear_Nm = v.torque_constant_Nm_per_A * plain(v.peak_current_A);
  if (kPeakTorque.excludes(plain(v.peak_torque_Nm) / linear_Nm)) {
    findings.error("peak_torque", LintClause{LintWords::peak_torque_of_current,
                                             {shown_torque(plain(v.peak_torque_Nm)), LintNumber{plain(v.peak_torque_Nm) / linear_Nm, 3},
                                              shown_torque(linear_Nm)}});
  }
}

void power_balance(const Motor& motor, Findings& findings) {
  const MotorValues& v = motor.nominal;
  const double input_W = v.nominal_voltage_V * plain(v.nominal_current_A);
  const double shaft_W = plain(v.nominal_torque_Nm) * plain(v.nominal_speed_rad_per_s);
  const double current_squared_A2 = plain(v.nominal_current_A) * plain(v.nominal_current_A);
  const double copper_W = current_squared_A2 * v.terminal_resistance_ohm;
  const LintClause found{LintWords::nominal_power, {shown(input_W, "W"), shown(shaft_W, "W")}};
  if (shaft_W + copper_W > (1.0 + kPowerTolerance) * input_W) {
    findings.error("nominal_torque",
                   LintClause{LintWords::nominal_power_above_input, {found, shown(copper_W, "W"), shown(shaft_W + copper_W, "W")}});
  }
  const double most_loss_W =
      current_squared_A2 * resistance_ohm(v, v.winding_limit_C) + drag_torque_Nm(v) * plain(v.nominal_speed_rad_per_s);
  const double explained = (shaft_W + most_loss_W) / input_W;
  if (explained > kPowerExplained.high) {
    findings.add(level_of_contradiction(motor, {"nominal_current", "nominal_torque", "nominal_speed", "terminal_resistance"}),
                 "terminal_resistance",
                 LintClause{LintWords::nominal_losses_too_large, {found, shown(most_loss_W, "W"), LintNumber{explained, 3}}});
  }
  if (explained < kPowerExplained.low) {
    findings.error("nominal_current", LintClause{LintWords::nominal_losses_too_small,
                                                 {found, shown(most_loss_W, "W"), shown(input_W - shaft_W - most_loss_W, "W")}});
  }
}

/// The assigned power holds for the motor type. A winding for low speed does not reach it at its own voltage (the 48 V, 3440 rpm winding of
/// a 70 W motor gives 36 W), but the type's torque at its highest speed must.
void assigned_power(const Motor& motor, Findings& findings) {
  const MotorValues& v = motor.nominal;
  const double torque_Nm = v.nominal_torque_Nm.value_or(v.torque_constant_Nm_per_A * plain(v.nominal_current_A));
  const double speed_rad_per_s = v.max_speed_rad_per_s.value_or(plain(v.no_load_speed_rad_per_s));
  if (plain(v.assigned_power_W) > (1.0 + kPowerTolerance) * torque_Nm * speed_rad_per_s) {
    findings.error("assigned_power", LintClause{LintWords::assigned_power_too_large,
                                                {shown(plain(v.assigned_power_W), "W"), shown_torque(torque_Nm),
                                                 shown_speed(speed_rad_per_s), shown(torque_Nm * speed_rad_per_s, "W")}});
    return;
  }
  const double input_W = v.nominal_voltage_V * plain(v.nominal_current_A);
  const double copper_W = plain(v.nominal_current_A) * plain(v.nominal_current_A) * v.terminal_resistance_ohm;
  if (plain(v.assigned_power_W) + copper_W > (1.0 + kPowerTolerance) * input_W) {
    findings.note("assigned_power", LintClause{LintWords::assigned_power_of_type,
                                               {shown(plain(v.assigned_power_W), "W"), shown(v.nominal_voltage_V, "V"),
                                                shown(plain(v.nominal_current_A), "A"), shown(input_W, "W"), shown(copper_W, "W")}});
  }
}

/// The speed loss at nominal torque is at least that of the cold resistance and at most that of hot copper plus full commutation overlap.
/// The check uses the speed constant, which the no-load speed confirms, so that a wrong torque constant does not disturb it.
void nominal_speed(const Motor& motor, Findings& findings) {
  const MotorValues& v = motor.nominal;
  const double constant_rad_per_s_per_V = v.speed_constant_rad_per_s_per_V.value_or(1.0 / v.torque_constant_Nm_per_A);
  const double loss_rad_per_s_per_ohm = constant_rad_per_s_per_V * constant_rad_per_s_per_V * plain(v.nominal_torque_Nm);
  const double fastest_rad_per_s = plain(v.no_load_speed_rad_per_s) - loss_rad_per_s_per_ohm * v.terminal_resistance_ohm;
  const double overlap_ohm = commutation_ohm(v);
  const double slowest_rad_per_s =
      plain(v.no_load_speed_rad_per_s) - loss_rad_per_s_per_ohm * (resistance_ohm(v, v.winding_limit_C) + overlap_ohm);
  if (plain(v.nominal_speed_rad_per_s) > (1.0 + kSpeedTolerance) * fastest_rad_per_s) {
    findings.error("nominal_speed", LintClause{LintWords::nominal_speed_too_high,
                                               {shown_speed(plain(v.nominal_speed_rad_per_s)),
                                                shown_speed(plain(v.no_load_speed_rad_per_s)), shown_torque(plain(v.nominal_torque_Nm)),
                                                shown(v.terminal_resistance_ohm, "ohm"), shown_speed(fastest_rad_per_s)}});
  }
  if (overlap_ohm > 0.0 && plain(v.nominal_speed_rad_per_s) < (1.0 - kSpeedTolerance) * slowest_rad_per_s) {
    const double hot_over_cold = resistance_ohm(v, v.winding_limit_C) / v.terminal_resistance_ohm;
    const double needed_ohm =
        ((plain(v.no_load_speed_rad_per_s) - plain(v.nominal_speed_rad_per_s)) / loss_rad_per_s_per_ohm - overlap_ohm) / hot_over_cold;
    findings.error("nominal_speed",
                   LintClause{LintWords::nominal_speed_too_low,
                              {shown_speed(plain(v.nominal_speed_rad_per_s)), shown_speed(plain(v.no_load_speed_rad_per_s)),
                               shown_torque(plain(v.nominal_torque_Nm)), shown(v.terminal_resistance_ohm, "ohm"),
                               shown_speed(slowest_rad_per_s), shown(plain(v.terminal_inductance_H) * 1e3, "mH"),
                               kAboutTwo.excludes(needed_ohm / v.terminal_resistance_ohm)
                                   ? LintClause{LintWords::resistance_needed, {shown(needed_ohm, "ohm")}}
                                   : LintClause{LintWords::resistance_of_one_phase, {shown(needed_ohm, "ohm")}}}});
  }
}

void nominal_point_heat_check(const Motor& motor, Findings& findings) {
  const std::optional<NominalPointHeat> heat = nominal_point_heat(motor);
  if (!heat) {
    return;
  }
  if (heat->limit_current_A == 0.0) {
    findings.add(level_of_heat(motor), "thermal_resistance_stator_ambient",
                 LintClause{LintWords::heat_without_current,
                            {shown_speed(plain(motor.nominal.nominal_speed_rad_per_s)), shown(motor.nominal.winding_limit_C, "degC"),
                             shown_torque(plain(motor.nominal.nominal_torque_Nm)), shown(kSheetAmbient_C, "degC")}});
    return;
  }
  const double ratio = heat->equivalent_current_A / heat->limit_current_A;
  const bool is_impossible = kHeat.excludes(ratio);
  if (is_impossible || (kUsualHeat.excludes(ratio) && level_of_heat(motor) == LintFinding::Level::error)) {
    findings.add(is_impossible ? level_of_heat(motor) : LintFinding::Level::warning, "nominal_torque",
                 LintClause{LintWords::nominal_heat,
                            {shown_torque(plain(motor.nominal.nominal_torque_Nm)), shown(heat->equivalent_current_A, "A"),
                             LintNumber{ratio, 3}, shown(heat->limit_current_A, "A"), shown(motor.nominal.winding_limit_C, "degC"),
                             LintClause{is_impossible ? LintWords::possible_heat : LintWords::usual_heat}}});
  }
}

/// Coarser check for sheets without nominal torque or speed: copper loss alone, at standstill.
void copper_limit(const Motor& motor, Findings& findings) {
  const MotorValues& v = motor.nominal;
  if (!v.nominal_current_A || !is_complete(motor) || nominal_point_heat(motor) || v.winding_limit_C <= kSheetAmbient_C) {
    return;
  }
  const double limit_A = limit_current_A(motor, 0.0);
  const double ratio = plain(v.nominal_current_A) / limit_A;
  if (kCopperLimit.excludes(ratio)) {
    findings.add(
        level_of_heat(motor), "nominal_current",
        LintClause{LintWords::copper_heat,
                   {shown(plain(v.nominal_current_A), "A"), LintNumber{ratio, 3}, shown(limit_A, "A"), shown(v.winding_limit_C, "degC")}});
  }
}

}  // namespace heatsoak::motor::lint_checks

namespace heatsoak::motor {

std::optional<NominalPointHeat> nominal_point_heat(const Motor& motor) {
  const MotorValues& v = motor.nominal;
  if (!v.nominal_torque_Nm || !v.nominal_speed_rad_per_s || !lint_checks::is_complete(motor) ||
      v.winding_limit_C <= lint_checks::kSheetAmbient_C) {
    return std::nullopt;
  }
  return NominalPointHeat{(*v.nominal_torque_Nm + drag_torque_Nm(v)) / v.torque_constant_Nm_per_A,
                          lint_checks::limit_current_A(motor, *v.nominal_speed_rad_per_s)};
}

}  // namespace heatsoak::motor
