// MuJoCo defaults for a <dcmotor> actuator. Names and law: google-deepmind/mujoco at a7255075b003506ff5f34b512d88e02df12a73c6,
// doc/XMLreference.rst (actuator-dcmotor-thermal), src/engine/engine_forward.c (mjDYN_DCMOTOR).
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

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

void require_datasheet_alone(const Derating& derating) {
  for (const ActingEffect& effect : derating.effects) {
    if (std::ranges::find(motor::kDatasheetEffects, effect.name) == motor::kDatasheetEffects.end()) {
      throw base::Failure(base::ExitCode::bad_input,
                          fmt::format("mujoco cannot express {} ({}): <dcmotor> has copper loss and one thermal resistance "
                                      "only; use --to c_header or --to json",
                                      effect.name, effect.type));
    }
  }
}

OmittedHeat no_load_heat(const Derating& derating) {
  const double speed_rad_per_s = derating.rules.most_speed_rad_per_s;
  const double loss_W = derating.observer.heat_safety_factor() * motor::drag_torque_Nm(derating.nominal) * speed_rad_per_s;
  return {loss_W, loss_W * derating.nominal.thermal_resistance_stator_ambient_K_per_W, speed_rad_per_s};
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
  const std::string about =
      provenance_lines(derating, "") +
      fmt::format(
          " Add to an actuator: dcmotor class=\"{0}\" joint=\"...\". Current is the equivalent DC current.\n"
          " The winding's temperature rise over the air of {1:.6g} degC is an activation of the actuator. MuJoCo does not limit\n"
          " the current by it: compare it with {2:.6g} K.\n"
          " The resistances contain the safety factor on heat, {6:.3g}, so this temperature is pessimistic under load.\n"
          " Not modelled: the stator's heat capacity (the winding warms faster here, and cools faster: after a\n"
          " pause it may be too cold by the stator's temperature rise), and no-load loss ({3:.2f} W and {4:.1f} K at {5:.0f} rad/s).\n"
          " Exact for a constant current at standstill.\n",
          in_attribute(derating.motor_id), derating.rules.hottest_ambient_C,
          derating.rules.limits.winding_C - derating.rules.hottest_ambient_C, omitted.loss_W / derating.observer.heat_safety_factor(),
          omitted.rise_K, omitted.speed_rad_per_s, derating.observer.heat_safety_factor());
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
