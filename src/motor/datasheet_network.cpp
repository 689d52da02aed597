#include "motor/datasheet_network.h"

#include "motor/conditions.h"

namespace heatsoak::motor {

bool is_loss_of_every_motor(const thermal::EffectType& type) { return type.name == "copper_loss" || type.name == "no_load_loss"; }

thermal::Network datasheet_network(const Motor& motor, const MotorSample& sample) {
  const MotorValues& values = sample.values;
  thermal::Network network;
  network.add_node("winding", values.thermal_time_constant_winding_s / values.thermal_resistance_winding_stator_K_per_W);
  network.add_node("stator", values.thermal_time_constant_stator_s / values.thermal_resistance_stator_ambient_K_per_W);
  const auto add = [&](std::string_view name, std::string_view type, std::vector<std::string> nodes, std::vector<double> parameters) {
    network.add_effect(std::string(name), *thermal::find_effect(type), nodes, parameters);
  };
  const auto& [copper, no_load, winding_stator, stator_ambient] = kDatasheetEffects;
  add(copper, "copper_loss", {"winding"}, {values.terminal_resistance_ohm, values.temperature_coefficient_per_K});
  add(no_load, "no_load_loss", {"stator"}, {drag_torque_Nm(values)});
  add(winding_stator, "conduction", {"winding", "stator"}, {values.thermal_resistance_winding_stator_K_per_W});
  add(stator_ambient, "conduction", {"stator", "ambient"}, {values.thermal_resistance_stator_ambient_K_per_W});
  network.limit_current_by(copper);
  for (std::size_t i = 0; i < motor.effects.size(); ++i) {
    const MotorEffect& effect = motor.effects[i];
    if (!effect.condition.empty() && !acts_by_default(effect, sample.effect_parameters[i])) {
      continue;
    }
    network.add_effect(effect.name, *effect.type, effect.nodes, sample.effect_parameters[i]);
  }
  return network;
}

}  // namespace heatsoak::motor
