// MuJoCo defaults for a <dcmotor> actuator. Names and law: google-deepmind/mujoco at a7255075b003506ff5f34b512d88e02df12a73c6,
// doc/XMLreference.rst (actuator-dcmotor-thermal), src/engine/engine_forward.c (mjDYN_DCMOTOR).
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "base/copper.h"
#include "base/diagnostic.h"
#include "derate/export_text.h"
#include "derate/exporter.h"
#include "motor/datasheet_network.h"

namespace heatsoak::derate::exporters {
namespace {

/// Removes "--", so that a user's text cannot end the XML comment.
std::string in_comment(std::string text) {
  for (std::size_t at = text.find("--"); at != std::string::npos; at = text.find("--")) {
    text[at + 1] = ' ';
  }
  return text;
}

std::string in_attribute(std::string_view id) {
  std::string text;
  for (const char c : id) {
    text += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == '.' ? c : '_';
  }
  return text;
}

/// Refuses everything that the motor's file adds to the data sheet's network, and the limits that depend on stator or speed. No-load loss,
/// which every motor has, is stated as omitted instead.
void require_datasheet_alone(const Derating& derating) {
  const auto refuse = [](const std::string& what, std::string_view why) {
    throw base::Failure(
        base::ExitCode::bad_input,
        fmt::format("mujoco cannot express {}: {}; for a simulation use --to fmi3_motor, for firmware --to c_header", what, why));
  };
  for (const ActingEffect& effect : derating.effects) {
    if (std::ranges::find(motor::kDatasheetEffects, effect.name) == motor::kDatasheetEffects.end()) {
      refuse(fmt::format("{} ({})", effect.name, effect.type), "<dcmotor> has copper loss and one thermal resistance only");
    }
  }
  if (derating.rules.limits.stator_C) {
    refuse(fmt::format("the stator_limit of {:.0f} °C", *derating.rules.limits.stator_C), "<dcmotor> has the winding's temperature only");
  }
  if (derating.rules.most_speed_rad_per_s < derating.reachable_speed_rad_per_s) {
    refuse(fmt::format("no_load_loss above {:.0f} rad/s", derating.rules.most_speed_rad_per_s),
           "there this motor exceeds its limit even without current, and <dcmotor> has no loss by speed");
  }
}

/// With resistance R·(1 + a·x) at a rise x, a constant loss that warms the stator by p and a current that warms the winding to its limit X
/// without this loss warm it to (X − p)/(1 + a·p).
OmittedHeat no_load_heat(const Derating& derating) {
  const motor::MotorValues& motor = derating.nominal;
  const double speed_rad_per_s = derating.rules.most_speed_rad_per_s;
  const double loss_W = derating.observer.heat_safety_factor() * motor::drag_torque_Nm(motor) * speed_rad_per_s;
  const double stator_rise_K = loss_W * motor.thermal_resistance_stator_ambient_K_per_W;
  const double limit_rise_K = derating.rules.limits.winding_C - derating.rules.hottest_ambient_C;
  const double per_K =
      motor.temperature_coefficient_per_K / base::resistance_ratio(motor.temperature_coefficient_per_K, derating.rules.hottest_ambient_C);
  return {loss_W, limit_rise_K - (limit_rise_K - stator_rise_K) / (1.0 + per_K * stator_rise_K), speed_rad_per_s};
}

/// MuJoCo: dT/dt = (R·i² − T/R_th)/C with R growing with the temperature. A safety factor r on heat becomes R_th·r and C/r.
std::string write_mujoco(const Derating& derating) {
  require_finite(derating);
  require_datasheet_alone(derating);
  const motor::MotorValues& motor = derating.nominal;
  const double reserve = derating.observer.heat_safety_factor() * derating.heating_current_ratio * derating.heating_current_ratio;
  const double winding_K_per_W = motor.thermal_resistance_winding_stator_K_per_W;
  const double stator_K_per_W = motor.thermal_resistance_stator_ambient_K_per_W;
  const double winding_J_per_K = motor.thermal_time_constant_winding_s / winding_K_per_W;
  const OmittedHeat omitted = no_load_heat(derating);
  const double limit_rise_K = derating.rules.limits.winding_C - derating.rules.hottest_ambient_C;
  const std::string about =
      provenance_lines(derating, "") +
      fmt::format(
          " Add to an actuator: dcmotor class=\"{0}\" joint=\"...\". Current is the equivalent DC current.\n"
          " The winding's temperature rise over the air of {1:.6g} degC is an activation of the actuator. MuJoCo does not limit\n"
          " the current by it: compare it with {2:.1f} K. This is the rise to the limit, {3:.6g} K, less {4:.1f} K for no-load loss, "
          "which\n"
          " this file does not model: {5:.2f} W at {6:.0f} rad/s.\n"
          " The resistances contain the safety factor on heat, {7:.3g}, so this temperature is pessimistic under load.\n"
          " Not modelled either: the stator's heat capacity. The winding warms faster here, and cools faster: after a pause it may\n"
          " be too cold by the stator's temperature rise.\n"
          " Exact for a constant current at standstill.\n",
          in_attribute(derating.motor_id), derating.rules.hottest_ambient_C, limit_rise_K - omitted.rise_K, limit_rise_K, omitted.rise_K,
          omitted.loss_W / derating.observer.heat_safety_factor(), omitted.speed_rad_per_s, derating.observer.heat_safety_factor());
  return fmt::format(
      "<!--\n{}-->\n"
      "<mujoco>\n"
      "  <default>\n"
      "    <default class=\"{}\">\n"
      "      <dcmotor resistance=\"{:.9g}\" motorconst=\"{:.9g} 0\"\n"
      "               thermal=\"{:.9g} {:.9g} 0 {:.9g} 25 {:.9g}\"\n"
      "               saturation=\"0 {:.9g} 0\"/>\n"
      "    </default>\n"
      "  </default>\n"
      "</mujoco>\n",
      in_comment(about), in_attribute(derating.motor_id), motor.terminal_resistance_ohm, motor.torque_constant_Nm_per_A,
      reserve * (winding_K_per_W + stator_K_per_W), winding_J_per_K / reserve, motor.temperature_coefficient_per_K,
      derating.rules.hottest_ambient_C, derating.rules.most_current_A);
}

}  // namespace

ExporterType mujoco() {
  return {.name = {},
          .summary = "MuJoCo defaults of a <dcmotor> with its thermal attributes; copper loss only, see its first lines",
          .write = write_mujoco,
          .omitted = no_load_heat};
}

}  // namespace heatsoak::derate::exporters
