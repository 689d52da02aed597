// Checks of the nominal point: motor constants, energy balance and heat.
#include <fmt/format.h>

#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <numbers>

#include "base/quantity.h"
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
    findings.error("no_load_current", fmt::format("no-load current {} is not below the nominal current {}; check both",
                                                  shown(v.no_load_current_A, "A"), shown(plain(v.nominal_current_A), "A")));
  }
  const double linear_Nm = v.torque_constant_Nm_per_A * plain(v.nominal_current_A);
  if (kNominalTorque.excludes(plain(v.nominal_torque_Nm) / linear_Nm)) {
    findings.error(
        "nominal_current",
        fmt::format("nominal torque {} is {} times K_t·I_n = {} (with {} and {}), expected 0.85 to 1.2 times; "
                    "check the nominal current and the convention of the torque constant",
                    shown_torque(plain(v.nominal_torque_Nm)), base::significant(plain(v.nominal_torque_Nm) / linear_Nm, 3),
                    shown_torque(linear_Nm), shown_torque_constant(v.torque_constant_Nm_per_A), shown(plain(v.nominal_current_A), "A")));
  }
}

void peak_point(const Motor& motor, Findings& findings) {
  const MotorValues& v = motor.nominal;
  if (plain(v.peak_torque_Nm) < plain(v.nominal_torque_Nm)) {
    findings.error("peak_torque", fmt::format("peak torque {} is less than the nominal torque {}; check both",
                                              shown_torque(plain(v.peak_torque_Nm)), shown_torque(plain(v.nominal_torque_Nm))));
  }
  if (plain(v.peak_current_A) < plain(v.nominal_current_A)) {
    findings.error("peak_current", fmt::format("peak current {} is less than the nominal current {}; check both",
                                               shown(plain(v.peak_current_A), "A"), shown(plain(v.nominal_current_A), "A")));
  }
  const double linear_Nm = v.torque_constant_Nm_per_A * plain(v.peak_current_A);
  if (kPeakTorque.excludes(plain(v.peak_torque_Nm) / linear_Nm)) {
    findings.error("peak_torque", fmt::format("peak torque {} is {} times K_t·I_peak = {}, expected 0.2 (saturated) to 1.2 times; "
                                              "check the peak current and the convention of the torque constant",
                                              shown_torque(plain(v.peak_torque_Nm)),
                                              base::significant(plain(v.peak_torque_Nm) / linear_Nm, 3), shown_torque(linear_Nm)));
  }
}

void power_balance(const Motor& motor, Findings& findings) {
  const MotorValues& v = motor.nominal;
  const double input_W = v.nominal_voltage_V * plain(v.nominal_current_A);
  const double shaft_W = plain(v.nominal_torque_Nm) * plain(v.nominal_speed_rad_per_s);
  const double current_squared_A2 = plain(v.nominal_current_A) * plain(v.nominal_current_A);
  const double copper_W = current_squared_A2 * v.terminal_resistance_ohm;
  const std::string found =
      fmt::format("at the nominal point {} go in (U·I_n) and {} come out at the shaft (T_n·ω_n)", shown(input_W, "W"), shown(shaft_W, "W"));
  if (shaft_W + copper_W > (1.0 + kPowerTolerance) * input_W) {
    findings.error("nominal_torque",
                   fmt::format("{}, but with {} of copper loss at 25 °C it takes {}, expected at most the input within 3 %; "
                               "check nominal current, speed, torque and resistance",
                               found, shown(copper_W, "W"), shown(shaft_W + copper_W, "W")));
  }
  const double most_loss_W =
      current_squared_A2 * resistance_ohm(v, v.winding_limit_C) + drag_torque_Nm(v) * plain(v.nominal_speed_rad_per_s);
  const double explained = (shaft_W + most_loss_W) / input_W;
  if (explained > kPowerExplained.high) {
    findings.add(
        level_of_contradiction(motor, {"nominal_current", "nominal_torque", "nominal_speed", "terminal_resistance"}), "terminal_resistance",
        fmt::format("{}; with {} lost in a winding at its limit and by drag it takes {} times the input, expected at most 1.08 times; "
                    "check resistance, nominal current, speed and torque",
                    found, shown(most_loss_W, "W"), base::significant(explained, 3)));
  }
  if (explained < kPowerExplained.low) {
    findings.error("nominal_current",
                   fmt::format("{}; hot copper and drag lose {}, which leaves {} unexplained, expected at most 15 % of the input; "
                               "check nominal current, speed and torque",
                               found, shown(most_loss_W, "W"), shown(input_W - shaft_W - most_loss_W, "W")));
  }
}

/// The assigned power holds for the motor type. A winding for low speed does not reach it at its own voltage (the 48 V, 3440 rpm winding of
/// a 70 W motor gives 36 W), but the type's torque at its highest speed must.
void assigned_power(const Motor& motor, Findings& findings) {
  const MotorValues& v = motor.nominal;
  const double torque_Nm = v.nominal_torque_Nm.value_or(v.torque_constant_Nm_per_A * plain(v.nominal_current_A));
  const double speed_rad_per_s = v.max_speed_rad_per_s.value_or(plain(v.no_load_speed_rad_per_s));
  if (plain(v.assigned_power_W) > (1.0 + kPowerTolerance) * torque_Nm * speed_rad_per_s) {
    findings.error("assigned_power",
                   fmt::format("{} are assigned, but the nominal torque {} up to the highest speed {} makes {}, expected at least the "
                               "assigned power; this may be the electrical input, check it",
                               shown(plain(v.assigned_power_W), "W"), shown_torque(torque_Nm), shown_speed(speed_rad_per_s),
                               shown(torque_Nm * speed_rad_per_s, "W")));
    return;
  }
  const double input_W = v.nominal_voltage_V * plain(v.nominal_current_A);
  const double copper_W = plain(v.nominal_current_A) * plain(v.nominal_current_A) * v.terminal_resistance_ohm;
  if (plain(v.assigned_power_W) + copper_W > (1.0 + kPowerTolerance) * input_W) {
    findings.note("assigned_power",
                  fmt::format("{} are assigned to the type, but at {} and {} this winding takes {} and loses {} of it in the copper: "
                              "it cannot give that power at its nominal voltage; use torque and speed instead",
                              shown(plain(v.assigned_power_W), "W"), shown(v.nominal_voltage_V, "V"),
                              shown(plain(v.nominal_current_A), "A"), shown(input_W, "W"), shown(copper_W, "W")));
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
    findings.error(
        "nominal_speed",
        fmt::format("{} is listed, but from {} without load {} through {} leave at most {} even with cold copper, expected "
                    "at most 3 % more; check resistance (between terminals?), nominal torque and speed",
                    shown_speed(plain(v.nominal_speed_rad_per_s)), shown_speed(plain(v.no_load_speed_rad_per_s)),
                    shown_torque(plain(v.nominal_torque_Nm)), shown(v.terminal_resistance_ohm, "ohm"), shown_speed(fastest_rad_per_s)));
  }
  if (overlap_ohm > 0.0 && plain(v.nominal_speed_rad_per_s) < (1.0 - kSpeedTolerance) * slowest_rad_per_s) {
    const double hot_over_cold = resistance_ohm(v, v.winding_limit_C) / v.terminal_resistance_ohm;
    const double needed_ohm =
        ((plain(v.no_load_speed_rad_per_s) - plain(v.nominal_speed_rad_per_s)) / loss_rad_per_s_per_ohm - overlap_ohm) / hot_over_cold;
    findings.error(
        "nominal_speed",
        fmt::format(
            "{} is listed, but from {} without load {} through {} leave at least {} with hot copper and commutation of {}, expected "
            "at most 3 % less; {}",
            shown_speed(plain(v.nominal_speed_rad_per_s)), shown_speed(plain(v.no_load_speed_rad_per_s)),
            shown_torque(plain(v.nominal_torque_Nm)), shown(v.terminal_resistance_ohm, "ohm"), shown_speed(slowest_rad_per_s),
            shown(plain(v.terminal_inductance_H) * 1e3, "mH"),
            kAboutTwo.excludes(needed_ohm / v.terminal_resistance_ohm)
                ? fmt::format("it would take {}: check resistance, nominal torque and speed", shown(needed_ohm, "ohm"))
                : fmt::format("it would take {}, about twice as much: if the resistance is that of one phase, set "
                              "conventions.terminal_resistance = \"phase_to_star\"",
                              shown(needed_ohm, "ohm"))));
  }
}

void nominal_point_heat_check(const Motor& motor, Findings& findings) {
  const std::optional<NominalPointHeat> heat = nominal_point_heat(motor);
  if (!heat) {
    return;
  }
  if (heat->limit_current_A == 0.0) {
    findings.add(
        level_of_heat(motor), "thermal_resistance_stator_ambient",
        fmt::format(
            "iron and friction loss at {} bring the winding to its limit of {} without any current, expected a nominal point of {} at "
            "{} to be possible; check no-load current and thermal resistances",
            shown_speed(plain(motor.nominal.nominal_speed_rad_per_s)), shown(motor.nominal.winding_limit_C, "degC"),
            shown_torque(plain(motor.nominal.nominal_torque_Nm)), shown(kSheetAmbient_C, "degC")));
    return;
  }
  const double ratio = heat->equivalent_current_A / heat->limit_current_A;
  const bool is_impossible = kHeat.excludes(ratio);
  if (is_impossible || (kUsualHeat.excludes(ratio) && level_of_heat(motor) == LintFinding::Level::error)) {
    findings.add(
        is_impossible ? level_of_heat(motor) : LintFinding::Level::warning, "nominal_torque",
        fmt::format(
            "the nominal torque {} and the drag take {}, {} times the {} that bring the winding to {} at 25 °C ambient, expected {}; check "
            "thermal resistances, winding limit, resistance and nominal point",
            shown_torque(plain(motor.nominal.nominal_torque_Nm)), shown(heat->equivalent_current_A, "A"), base::significant(ratio, 3),
            shown(heat->limit_current_A, "A"), shown(motor.nominal.winding_limit_C, "degC"),
            is_impossible ? "0.85 to 1.1 times" : "0.94 to 1.05 times, as on known sheets"));
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
        fmt::format(
            "nominal current {} is {} times the {} that bring the winding to {} by copper loss alone at 25 °C ambient, expected 0.65 to "
            "1.05 times; check thermal resistances, winding limit and resistance",
            shown(plain(v.nominal_current_A), "A"), base::significant(ratio, 3), shown(limit_A, "A"), shown(v.winding_limit_C, "degC")));
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
