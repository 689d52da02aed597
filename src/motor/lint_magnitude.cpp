// Checks of orders of magnitude: values that no real motor has.
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

#include "base/quantity.h"
#include "motor/lint_checks.h"

namespace heatsoak::motor::lint_checks {
namespace {

/// Copper (385 J/(kg K)) is 3 to 30 % of a motor's mass, and resin adds at most as much again; maxon sheets give 32 to 51 J/(kg K).
constexpr Bounds kWindingHeat_J_per_kg_K{10.0, 150.0};
/// Steel 460, magnets 450, aluminium 900 J/(kg K). Upper bound: all of the mass counts. Lower bound: a stator of a quarter of the mass,
/// because an external rotor may not contribute. Maxon sheets give 355 to 455 J/(kg K).
constexpr Bounds kStatorHeat_J_per_kg_K{100.0, 900.0};
/// L/R does not depend on the number of turns: in motor_db 0.058 ms without iron, 0.38 to 1.0 ms with iron. A wrong prefix or an extra zero
/// is a factor of 10.
constexpr Bounds kElectrical_s{20e-6, 5e-3};
/// Steel has 7850, magnets 7500, aluminium 2700, resin 1200 kg/m³. With its gaps a motor is less dense than solid magnet and steel.
/// motor_db has 3860 to 5330 kg/m³.
constexpr Bounds kDensity_kg_per_m3{1500.0, 7500.0};
constexpr Bounds kUsualDensity_kg_per_m3{3000.0, 6500.0};
/// J/(m·r²): 1 if all mass is in a thin ring, 0.5 if half of it is; motor_db has 0.05 to 0.28.
constexpr double kMostInertia = 0.5;
/// An external rotor is a bell with the magnets in it: 8 % of the mass with a radius of gyration of 0.6 r gives 0.03. motor_db has 0.05 to
/// 0.28 for external rotors, 0.018 to 0.028 for the internal ones of the EC-i 40.
constexpr double kLeastExternalInertia = 0.03;
/// Lasting over stall current, the root of the share of the stall power that the motor can shed. Usual: motor_db has 0.06 to 0.31, a
/// traction motor of 52 kW 0.025. Possible: gimbal motors hold their stall current continuously. A wrong prefix of the resistance is a factor of
/// 32.
constexpr Bounds kUsualLasting_share{0.015, 0.5};
constexpr Bounds kLasting_share{0.003, 3.0};
/// U/K_t as a speed: motor_db has 3500 to 14000 rpm. Usual: from hub motors to fans; possible: from torque motors of machine tools to
/// turbo compressors.
constexpr Bounds kUsualSpeed_rpm{200.0, 60000.0};
constexpr Bounds kSpeed_rpm{20.0, 300000.0};
/// The no-load loss may heat the stator by this share of the room below the winding limit; motor_db has 0.08 to 0.51. Small motors that an
/// own propeller cools exceed it, but not tenfold.
constexpr double kUsualNoLoadHeating_share = 1.0;
constexpr double kNoLoadHeating_share = 10.0;
/// Stator-ambient over winding-stator: motor_db has 0.19 to 5.3.
constexpr Bounds kUsualThermalResistance_ratio{0.05, 20.0};
/// Stator over winding: motor_db has 7 to 14. Copper is at least 3 % of the mass, which gives 40; a mounting plate may come on top.
constexpr double kUsualHeatCapacity_ratio = 100.0;
constexpr double kHeatCapacity_ratio = 1000.0;
/// Size of an effect over the motor's own value of that kind. Usual: src/thermal/effects describes sizes of 0.02 to 0.3 W/K, up to 3 W, 5
/// to 20 mohm and 30 to 500 J/K for motors of 0.1 kg. Possible: a wrong prefix is a factor of 1000. A body may weigh as much as the robot.
constexpr double kUsualEffect_ratio = 5.0;
constexpr double kEffect_ratio = 100.0;
constexpr Bounds kUsualBody_ratio{1e-3, 100.0};
constexpr Bounds kBody_ratio{1e-5, 10000.0};
/// A motor shorter than this share of its diameter counts as flat; nearly all flat motors have an external rotor.
constexpr double kFlat = 0.7;

double body_area_m2(const MotorValues& v) { return std::numbers::pi / 4.0 * plain(v.diameter_m) * plain(v.diameter_m); }

LintClause shown_heat(double heat_J_per_K, double mass_kg) {
  return LintClause{LintWords::heat_capacity,
                    {shown(heat_J_per_K, "J/K"), shown(heat_J_per_K / mass_kg, "J/(kg K)"), shown(1e3 * mass_kg, "g")}};
}

/// Reports an error outside `possible`, a warning outside `usual`.
void compare(Findings& findings, std::string_view key, double value, const Bounds& usual, const Bounds& possible, LintClause what) {
  if (possible.excludes(value)) {
    findings.error(key, std::move(what));
  } else if (usual.excludes(value)) {
    findings.warning(key, std::move(what));
  }
}

void lasting_current(const MotorValues& v, Findings& findings) {
  const double thermal_resistance_K_per_W = v.thermal_resistance_winding_stator_K_per_W + v.thermal_resistance_stator_ambient_K_per_W;
  const double shed_W = (v.winding_limit_C - kSheetAmbient_C) / thermal_resistance_K_per_W;
  const double lasting_A = std::sqrt(shed_W / resistance_ohm(v, v.winding_limit_C));
  const double stall_A = v.nominal_voltage_V / v.terminal_resistance_ohm;
  const double share = lasting_A / stall_A;
  compare(findings, "terminal_resistance", share, kUsualLasting_share, kLasting_share,
          LintClause{LintWords::lasting_current,
                     {shown(lasting_A, "A"), LintNumber{share, 4}, shown(stall_A, "A"), shown(v.nominal_voltage_V, "V"),
                      shown(v.terminal_resistance_ohm, "ohm")}});
}

void ideal_speed(const MotorValues& v, Findings& findings) {
  const double speed_rad_per_s = v.nominal_voltage_V / v.torque_constant_Nm_per_A;
  compare(findings, "torque_constant", base::convert(speed_rad_per_s, "rad/s", "rpm"), kUsualSpeed_rpm, kSpeed_rpm,
          LintClause{LintWords::ideal_speed,
                     {shown(v.nominal_voltage_V, "V"), shown_torque_constant(v.torque_constant_Nm_per_A), shown_speed(speed_rad_per_s)}});
}

void no_load_heating(const MotorValues& v, Findings& findings) {
  const double room_K = v.winding_limit_C - kSheetAmbient_C;
  const double heating_K = v.nominal_voltage_V * v.no_load_current_A * v.thermal_resistance_stator_ambient_K_per_W;
  compare(findings, "no_load_current", heating_K / room_K, {0.0, kUsualNoLoadHeating_share}, {0.0, kNoLoadHeating_share},
          LintClause{LintWords::no_load_heating,
                     {shown(v.no_load_current_A, "A"), shown(v.nominal_voltage_V, "V"), shown(heating_K, "K"),
                      shown(v.thermal_resistance_stator_ambient_K_per_W, "K/W"), shown(room_K, "K")}});
}

void thermal_ratios(const MotorValues& v, Findings& findings) {
  const double winding_K_per_W = v.thermal_resistance_winding_stator_K_per_W;
  const double ambient_K_per_W = v.thermal_resistance_stator_ambient_K_per_W;
  const double ratio = ambient_K_per_W / winding_K_per_W;
  if (kUsualThermalResistance_ratio.excludes(ratio)) {
    findings.warning("thermal_resistance_stator_ambient",
                     LintClause{LintWords::thermal_resistance_ratio,
                                {shown(ambient_K_per_W, "K/W"), LintNumber{ratio, 2}, shown(winding_K_per_W, "K/W")}});
  }
  const double stator_J_per_K = v.thermal_time_constant_stator_s / ambient_K_per_W;
  const double winding_J_per_K = v.thermal_time_constant_winding_s / winding_K_per_W;
  compare(findings, "thermal_time_constant_stator", stator_J_per_K / winding_J_per_K, {0.0, kUsualHeatCapacity_ratio},
          {0.0, kHeatCapacity_ratio},
          LintClause{LintWords::heat_capacity_ratio, {shown(stator_J_per_K, "J/K"), shown(winding_J_per_K, "J/K")}});
}

/// A value of the motor itself with which the size of an effect is compared.
struct OwnValue {
  double value = base::kUnknown;
  LintWords words = LintWords::own_conductance;
  Bounds usual{0.0, kUsualEffect_ratio};
  Bounds possible{0.0, kEffect_ratio};
};

/// Returns the motor's own value in the unit of a parameter; unknown for units without one.
OwnValue own_value(const MotorValues& v, std::string_view unit) {
  if (unit == "W/K") {
    return {.value = 1.0 / v.thermal_resistance_winding_stator_K_per_W + 1.0 / v.thermal_resistance_stator_ambient_K_per_W};
  }
  if (unit == "W") {
    return {.value = (v.winding_limit_C - kSheetAmbient_C) / v.thermal_resistance_stator_ambient_K_per_W,
            .words = LintWords::room_of_stator};
  }
  if (unit == "ohm") {
    return {.value = v.terminal_resistance_ohm, .words = LintWords::own_resistance};
  }
  if (unit == "J/K") {
    return {.value = v.thermal_time_constant_winding_s / v.thermal_resistance_winding_stator_K_per_W +
                     v.thermal_time_constant_stator_s / v.thermal_resistance_stator_ambient_K_per_W,
            .words = LintWords::own_heat_capacity,
            .usual = kUsualBody_ratio,
            .possible = kBody_ratio};
  }
  return {};
}

}  // namespace

/// The declared range of a conductance, loss or heat capacity has no upper end, because it depends on the size of the motor.
void effect_sizes(const Motor& motor, Findings& findings) {
  for (const MotorEffect& effect : motor.effects) {
    const std::vector<double> values = effect.values();
    for (std::size_t i = 0; i < effect.parameters.size(); ++i) {
      const base::ParameterSpec& spec = effect.type->parameters[i];
      const std::string_view unit = base::unit_of(effect.type->parameters, i, values);
      const OwnValue own = own_value(motor.nominal, unit);
      const double ratio = std::abs(effect.parameters[i].value) / own.value;
      if (!spec.choices.empty() || !own.usual.excludes(ratio)) {
        continue;
      }
      LintClause what{LintWords::effect_size,
                      {effect.name, spec.key, shown(effect.parameters[i].value, unit), LintNumber{ratio, 3},
                       LintClause{own.words, {shown(own.value, unit)}}, LintNumber{own.usual.low, 1}, LintNumber{own.usual.high, 3}}};
      if (own.possible.excludes(ratio)) {
        findings.error_at(effect.parameters[i].at, std::move(what));
      } else {
        findings.warning_at(effect.parameters[i].at, std::move(what));
      }
    }
  }
}

void required_values(const Motor& motor, Findings& findings) {
  if (!is_complete(motor)) {
    return;
  }
  if (motor.nominal.winding_limit_C > kSheetAmbient_C) {  // else limits() reports it
    lasting_current(motor.nominal, findings);
    no_load_heating(motor.nominal, findings);
  }
  ideal_speed(motor.nominal, findings);
  thermal_ratios(motor.nominal, findings);
}

void heat_capacities(const Motor& motor, Findings& findings) {
  const MotorValues& v = motor.nominal;
  const double winding_J_per_K = v.thermal_time_constant_winding_s / v.thermal_resistance_winding_stator_K_per_W;
  const double stator_J_per_K = v.thermal_time_constant_stator_s / v.thermal_resistance_stator_ambient_K_per_W;
  if (kWindingHeat_J_per_kg_K.excludes(winding_J_per_K / plain(v.mass_kg))) {
    findings.error("thermal_time_constant_winding",
                   LintClause{LintWords::winding_heat_capacity, {shown_heat(winding_J_per_K, plain(v.mass_kg))}});
  }
  if (kStatorHeat_J_per_kg_K.excludes(stator_J_per_K / plain(v.mass_kg))) {
    findings.error("thermal_time_constant_stator",
                   LintClause{LintWords::stator_heat_capacity, {shown_heat(stator_J_per_K, plain(v.mass_kg))}});
  }
  if (winding_J_per_K >= stator_J_per_K) {
    findings.error("thermal_time_constant_winding",
                   LintClause{LintWords::heat_capacities_swapped, {shown(winding_J_per_K, "J/K"), shown(stator_J_per_K, "J/K")}});
  }
}

void electrical_time_constant(const Motor& motor, Findings& findings) {
  const MotorValues& v = motor.nominal;
  const double time_constant_s = plain(v.terminal_inductance_H) / v.terminal_resistance_ohm;
  if (kElectrical_s.excludes(time_constant_s)) {
    findings.error("terminal_inductance", LintClause{LintWords::electrical_time_constant,
                                                     {shown(1e3 * plain(v.terminal_inductance_H), "mH"),
                                                      shown(v.terminal_resistance_ohm, "ohm"), shown(1e3 * time_constant_s, "ms")}});
  }
}

void density(const Motor& motor, Findings& findings) {
  const MotorValues& v = motor.nominal;
  const double density_kg_per_m3 = plain(v.mass_kg) / (body_area_m2(v) * plain(v.length_m));
  const LintClause found{LintWords::density,
                         {shown(1e3 * plain(v.mass_kg), "g"), shown(1e3 * plain(v.diameter_m), "mm"), shown(1e3 * plain(v.length_m), "mm"),
                          LintNumber{density_kg_per_m3, 3}}};
  if (kDensity_kg_per_m3.excludes(density_kg_per_m3)) {
    findings.error("mass", LintClause{LintWords::density_impossible, {found}});
  } else if (kUsualDensity_kg_per_m3.excludes(density_kg_per_m3)) {
    findings.warning(density_kg_per_m3 < kUsualDensity_kg_per_m3.low ? "length" : "mass", LintClause{LintWords::density_unusual, {found}});
  }
}

void rotor_inertia(const Motor& motor, Findings& findings) {
  const MotorValues& v = motor.nominal;
  const double ring_kg_m2 = plain(v.mass_kg) * 0.25 * plain(v.diameter_m) * plain(v.diameter_m);
  const double ratio = plain(v.rotor_inertia_kg_m2) / ring_kg_m2;
  if (ratio > kMostInertia) {
    findings.error("rotor_inertia", LintClause{LintWords::inertia_too_large,
                                               {shown_inertia(plain(v.rotor_inertia_kg_m2)), shown_inertia(ring_kg_m2),
                                                shown(1e3 * plain(v.mass_kg), "g"), shown(500.0 * plain(v.diameter_m), "mm")}});
  }
  const bool is_external = motor.rotor == "external";
  const bool may_be_external = is_external || (motor.rotor.empty() && plain(v.length_m) < kFlat * plain(v.diameter_m));
  if (may_be_external && ratio < kLeastExternalInertia) {
    findings.add(is_external ? LintFinding::Level::error : LintFinding::Level::warning, "rotor_inertia",
                 LintClause{LintWords::external_inertia_too_small,
                            {shown_inertia(plain(v.rotor_inertia_kg_m2)), shown(1e3 * plain(v.mass_kg), "g"),
                             shown(1e3 * plain(v.diameter_m), "mm"), shown_inertia(kLeastExternalInertia * ring_kg_m2),
                             LintClause{is_external ? LintWords::check_external_rotor : LintWords::check_flat_rotor}}});
  }
}

void limits(const Motor& motor, Findings& findings) {
  const MotorValues& v = motor.nominal;
  const auto compare_temperature = [&](std::string_view key, double lower_C, LintWords lower, double upper_C, LintWords upper) {
    if (lower_C >= upper_C) {
      findings.error(key, LintClause{LintWords::temperatures_out_of_order,
                                     {LintClause{lower}, shown(lower_C, "degC"), LintClause{upper}, shown(upper_C, "degC")}});
    }
  };
  compare_temperature("winding_limit", kSheetAmbient_C, LintWords::sheet_ambient, v.winding_limit_C, LintWords::winding_limit);
  compare_temperature("ambient_max", plain(v.ambient_max_C), LintWords::ambient_max, v.winding_limit_C, LintWords::winding_limit);
  compare_temperature("ambient_min", plain(v.ambient_min_C), LintWords::ambient_min, plain(v.ambient_max_C), LintWords::highest);
  if (plain(v.stator_limit_C) > v.winding_limit_C) {
    findings.error("stator_limit", LintClause{LintWords::stator_limit_above_winding,
                                              {shown(plain(v.stator_limit_C), "degC"), shown(v.winding_limit_C, "degC")}});
  }
  if (plain(v.nominal_speed_rad_per_s) > plain(v.max_speed_rad_per_s)) {
    findings.error("max_speed", LintClause{LintWords::nominal_speed_above_highest,
                                           {shown_speed(plain(v.nominal_speed_rad_per_s)), shown_speed(plain(v.max_speed_rad_per_s))}});
  } else if (plain(v.no_load_speed_rad_per_s) > plain(v.max_speed_rad_per_s)) {
    findings.note("max_speed", LintClause{LintWords::no_load_speed_above_highest,
                                          {shown_speed(plain(v.no_load_speed_rad_per_s)), shown_speed(plain(v.max_speed_rad_per_s))}});
  }
}

}  // namespace heatsoak::motor::lint_checks
