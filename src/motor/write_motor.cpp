#include "motor/write_motor.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/quantity.h"
#include "input/toml_text.h"

namespace heatsoak::motor {
namespace {

constexpr int kDigits = 6;

std::string amount(double value, const std::string& unit) {
  return unit.empty() ? base::significant(value, kDigits) : fmt::format("{} {}", base::significant(value, kDigits), unit);
}

std::string parameter_text(const base::ParameterValue& parameter, const std::string& unit) {
  const base::ParsedQuantity printed = base::parse_quantity(parameter.printed, unit);
  const bool is_as_printed = printed.ok() && std::abs(printed.value - parameter.value) <= 1e-9 * std::abs(parameter.value);
  std::string text =
      fmt::format("{{ value = {}, origin = {}", input::toml_text(is_as_printed ? parameter.printed : amount(parameter.value, unit)),
                  input::toml_text(base::to_string(parameter.origin)));
  if (!parameter.source.empty()) {
    std::vector<std::string> ids;
    for (std::size_t at = 0; at < parameter.source.size();) {
      const std::size_t end = std::min(parameter.source.find(", ", at), parameter.source.size());
      ids.push_back(input::toml_text(parameter.source.substr(at, end - at)));
      at = end + 2;
    }
    text += ids.size() == 1 ? fmt::format(", source = {}", ids.front()) : fmt::format(", source = [{}]", fmt::join(ids, ", "));
  }
  // A percentage of zero is zero: the tolerance of a value of 0 cannot be written.
  if (parameter.spread && (parameter.spread->kind == base::Spread::Kind::range || unit == "degC" || parameter.value != 0.0)) {
    const base::Spread& spread = *parameter.spread;
    const double half = 0.5 * (spread.high - spread.low);
    if (spread.kind == base::Spread::Kind::range) {
      text += fmt::format(", range = [{}, {}]", input::toml_text(amount(spread.low, unit)), input::toml_text(amount(spread.high, unit)));
    } else if (unit == "degC") {
      text += fmt::format(", tolerance = {}", input::toml_text(amount(half, "K")));
    } else {
      text += fmt::format(", tolerance = {}", input::toml_text(amount(100.0 * half / std::abs(parameter.value), "%")));
    }
  }
  if (!parameter.derivation.empty()) {
    text += fmt::format(", derivation = {}", input::toml_text(parameter.derivation));
  }
  return text + " }";
}

std::string head_of_effect(const std::string& name, std::string_view type) {
  return fmt::format("\n[effects.{}]\n{}", name, name != type ? fmt::format("type = {}\n", input::toml_text(type)) : "");
}

std::string effect_text(const MotorEffect& effect) {
  std::string text = head_of_effect(effect.name, effect.type->name);
  for (std::size_t role = 0; role < effect.nodes.size(); ++role) {
    // A node of the effect's own has the effect's name and is not written.
    if (!effect.type->nodes[role].own_capacity) {
      text += fmt::format("{} = {}\n", effect.type->nodes[role].role, input::toml_text(effect.nodes[role]));
    }
  }
  std::vector<double> values;
  for (std::size_t i = 0; i < effect.parameters.size(); ++i) {
    const base::ParameterSpec& spec = effect.type->parameters[i];
    const std::string unit(base::unit_of(effect.type->parameters, i, values));
    values.push_back(effect.parameters[i].value);
    text += fmt::format("{} = {}\n", spec.key,
                        spec.choices.empty() ? parameter_text(effect.parameters[i], unit) : input::toml_text(effect.parameters[i].printed));
  }
  text += effect.column.empty() ? "" : fmt::format("column = {}\n", input::toml_text(effect.column));
  if (!effect.condition.empty()) {
    text += fmt::format("[effects.{}.condition]\n", effect.name);
    for (const auto& [key, value] : effect.condition) {
      text += fmt::format("{} = {}\n", key, input::toml_text(value));
    }
  }
  return text;
}

}  // namespace

std::string joined_sources(std::string_view ids, std::string_view more) {
  constexpr std::string_view kComma = ", ";
  std::vector<std::string_view> all;
  for (std::string_view rest : {ids, more}) {
    while (!rest.empty()) {
      const std::string_view id = rest.substr(0, rest.find(kComma));
      if (std::ranges::find(all, id) == all.end()) {
        all.push_back(id);
      }
      rest.remove_prefix(std::min(rest.size(), id.size() + kComma.size()));
    }
  }
  return fmt::format("{}", fmt::join(all, kComma));
}

std::string to_toml(const Motor& motor) {
  std::string text = fmt::format("manufacturer = {}\nname = {}\n", input::toml_text(motor.manufacturer), input::toml_text(motor.name));
  if (!motor.part_number.empty()) {
    text += fmt::format("part_number = {}\n", input::toml_text(motor.part_number));
  }
  text += fmt::format("type = {}\n", input::toml_text(motor.type));
  text += motor.rotor.empty() ? "" : fmt::format("rotor = {}\n", input::toml_text(motor.rotor));
  if (!motor.notes.empty()) {
    text += "notes = [\n";
    for (const std::string& note : motor.notes) {
      text += fmt::format("  {},\n", input::toml_text(note));
    }
    text += "]\n";
  }
  text += "\n[sources]\n";
  for (const auto& [id, what] : motor.sources) {
    text += fmt::format("{} = {}\n", id, input::toml_text(what));
  }
  text += fmt::format(
      "\n[conventions]\nterminal_resistance = \"between_terminals\"\ntorque_constant = \"per_dc_ampere\"\nstall_includes_saturation = {}\n",
      motor.stall_includes_saturation);
  text += "\n[figures]\n";
  for (const MotorParameterSpec& each : motor_parameter_specs()) {
    if (const auto found = motor.parameters.find(each.spec.key); found != motor.parameters.end()) {
      text += fmt::format("{} = {}\n", each.spec.key, parameter_text(found->second, std::string(each.spec.unit)));
    }
  }
  for (const MotorEffect& effect : motor.effects) {
    text += effect_text(effect);
  }
  for (const MotorSensor& sensor : motor.sensors) {
    text += fmt::format("{}{} = {}\n", head_of_effect(sensor.name, sensor.type->name), sensor.type->size.key,
                        parameter_text(sensor.size, std::string(sensor.type->size.unit)));
  }
  return input::with_short_lines(motor.fit ? text + to_toml(*motor.fit) : text);
}

}  // namespace heatsoak::motor
