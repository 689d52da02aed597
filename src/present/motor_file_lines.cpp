#include "present/motor_file_lines.h"

#include <fmt/format.h>

#include "base/quantity.h"

namespace heatsoak::present {

std::string effect_table(std::string_view type_name) { return fmt::format("[effects.my_{}]\ntype = \"{}\"\n", type_name, type_name); }

std::string typical_value(std::string_view key, double value, std::string_view unit) {
  // Dotted keys keep the lines short.
  return fmt::format("{0}.value = \"{1}{2}{3}\"\n{0}.origin = \"estimated\"\n{0}.derivation = \"typical size\"\n", key,
                     base::significant(value, 6), unit.empty() ? "" : " ", unit);
}

std::string motor_file_lines(const thermal::EffectType& effect) {
  const std::vector<double>& values = effect.candidacy.variants.empty() ? effect.example.parameters : effect.candidacy.variants.front();
  std::string text = effect_table(effect.name);
  for (const thermal::NodeRole& role : effect.nodes) {
    text += !role.own_capacity ? fmt::format("{} = \"{}\"\n", role.role, role.default_node) : "";
  }
  for (std::size_t i = 0; i < effect.parameters.size(); ++i) {
    const base::ParameterSpec& spec = effect.parameters[i];
    text += spec.choices.empty() ? typical_value(spec.key, values[i], base::unit_of(effect.parameters, i, values))
                                 : fmt::format("{} = \"{}\"\n", spec.key, spec.choices[static_cast<std::size_t>(values[i])].name);
  }
  return text;
}

}  // namespace heatsoak::present
