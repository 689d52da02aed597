#include "motor/motor_effects.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "motor/datasheet_network.h"

namespace heatsoak::motor {
namespace {

constexpr std::array<std::string_view, 3> kNodes{"winding", "stator", thermal::Network::kAmbient};

bool is_word(std::string_view name) {
  return !name.empty() && std::ranges::all_of(name, [](char c) { return c == '_' || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); });
}

bool brings_node(const thermal::EffectType& type) {
  return std::ranges::any_of(type.nodes, [](const thermal::NodeRole& role) { return role.own_capacity.has_value(); });
}

struct Entry {
  std::string name;
  input::Reader reader;
  const thermal::EffectType* type;  ///< null for a sensor error
  const SensorEffectType* sensor;   ///< null for a thermal effect
};

std::vector<std::string> known_types() {
  std::vector<std::string> known;
  for (const thermal::EffectType& type : thermal::all_effects()) {
    known.emplace_back(type.name);
  }
  for (const SensorEffectType& type : all_sensor_effects()) {
    known.emplace_back(type.name);
  }
  return known;
}

/// Returns the tables with a valid name and type; adds a problem for each other one.
std::vector<Entry> entries_of(input::Reader& table) {
  std::vector<Entry> entries;
  for (auto& [name, reader] : table.named_tables()) {
    if (std::ranges::find(kDatasheetEffects, name) != kDatasheetEffects.end()) {
      table.problem(name, "is the name of an effect that every motor has; give this one another name and set type = \"…\"");
      continue;
    }
    const std::string type_name = reader.text("type", input::Need::optional).value_or(name);
    const thermal::EffectType* type = thermal::find_effect(type_name);
    const SensorEffectType* sensor = find_sensor_effect(type_name);
    if (!type && !sensor) {
      table.problem(name, fmt::format("there is no effect '{}'{} (`heatsoak list effects` shows all)", type_name,
                                      base::did_you_mean(type_name, known_types())));
      continue;
    }
    if (!is_word(name)) {
      table.problem(name, "is not a valid name for an effect; expected small letters, digits and underscores");
      continue;
    }
    if (type && brings_node(*type) && std::ranges::find(kNodes, name) != kNodes.end()) {
      table.problem(name, fmt::format("is the name of a node, and {} adds a node of its own; give it another name and set type = \"{}\"",
                                      type_name, type_name));
      continue;
    }
    entries.push_back({name, std::move(reader), type, sensor});
  }
  return entries;
}

void read_nodes(Entry& entry, const std::vector<std::string>& known, MotorEffect& effect) {
  for (const thermal::NodeRole& role : entry.type->nodes) {
    if (role.own_capacity) {
      effect.nodes.push_back(entry.name);
      continue;
    }
    effect.nodes.push_back(entry.reader.text(role.role, input::Need::optional).value_or(std::string(role.default_node)));
    if (std::ranges::find(known, effect.nodes.back()) == known.end() ||
        effect.nodes.back() == (brings_node(*entry.type) ? entry.name : "")) {
      const std::vector<std::string> before(known.begin(), known.end() - 1);
      entry.reader.problem(
          role.role, fmt::format("'{}' is not a node; expected {} or {}", effect.nodes.back(), fmt::join(before, ", "), known.back()));
    } else if (role.is_surroundings && effect.nodes.back() != role.default_node) {
      entry.reader.problem(role.role, fmt::format("'{}' is a node of the motor; expected '{}'", effect.nodes.back(), role.default_node));
    } else if (role.is_surroundings && effect.nodes.front() == role.default_node) {
      entry.reader.problem(entry.type->nodes.front().role,
                           fmt::format("'{}' is the surroundings; expected a node of the motor", role.default_node));
    } else if (entry.type->moves_copper_loss && effect.nodes.size() == 1 && effect.nodes.front() != role.default_node) {
      entry.reader.problem(role.role, fmt::format("'{}' has no copper loss; expected '{}'", effect.nodes.front(), role.default_node));
    } else if (entry.type->moves_copper_loss &&
               (effect.nodes.back() == thermal::Network::kAmbient || std::ranges::count(effect.nodes, effect.nodes.back()) > 1)) {
      entry.reader.problem(role.role, fmt::format("'{}' cannot exchange loss with '{}'; expected two nodes of the motor",
                                                  effect.nodes.front(), effect.nodes.back()));
    }
  }
}

void read_parameters(input::Reader& reader, const thermal::EffectType& type, MotorEffect& effect) {
  std::vector<double> values;
  bool chosen = true;
  for (std::size_t i = 0; i < type.parameters.size(); ++i) {
    base::ParameterSpec spec = type.parameters[i];
    base::ParameterValue parameter;
    if (!spec.choices.empty()) {
      std::vector<std::string_view> names;
      for (const base::Choice& choice : spec.choices) {
        names.push_back(choice.name);
      }
      const std::optional<std::string> name = reader.choice(spec.key, names, input::Need::required);
      chosen = chosen && name;
      parameter.printed = name.value_or("");
      parameter.value = name ? static_cast<double>(std::ranges::find(names, *name) - names.begin()) : 0.0;
    } else if (spec.unit_of && !chosen) {
      reader.pass_over(spec.key);
    } else {
      spec.unit = base::unit_of(type.parameters, i, values);
      parameter = reader.parameter(spec, input::Need::required).value_or(base::ParameterValue{});
    }
    values.push_back(parameter.value);
    effect.parameters.push_back(std::move(parameter));
  }
}

bool goes_with_column(const MotorEffect& effect) {
  return std::ranges::any_of(effect.parameters, [](const base::ParameterValue& each) { return thermal::is_column_choice(each.printed); });
}

/// Gives the effect the place of its column among the motor's columns. Returns false if there is no free one.
bool take_place(MotorEffect& effect, std::vector<std::string>& columns) {
  const auto place = static_cast<std::size_t>(std::ranges::find(columns, effect.column) - columns.begin());
  if (place == thermal::kLogColumns) {
    return false;
  }
  if (place == columns.size()) {
    columns.push_back(effect.column);
  }
  const auto chosen =
      std::ranges::find_if(effect.parameters, [](const base::ParameterValue& each) { return thermal::is_column_choice(each.printed); });
  const base::ParameterSpec& spec = effect.type->parameters[static_cast<std::size_t>(chosen - effect.parameters.begin())];
  chosen->printed = thermal::kColumnChoice;
  chosen->value =
      static_cast<double>(std::ranges::find(spec.choices, thermal::kColumnChoices[place], &base::Choice::name) - spec.choices.begin());
  return true;
}

/// Orders the effects so that every node is added before it is used; otherwise the order of the file is kept.
std::vector<MotorEffect> in_order(std::vector<MotorEffect> waiting, input::Reader& table) {
  std::vector<std::string> there(kNodes.begin(), kNodes.end());
  std::vector<MotorEffect> ordered;
  const auto is_there = [&](const MotorEffect& effect) {
    return std::ranges::all_of(effect.nodes, [&](const std::string& node) {
      return (node == effect.name && brings_node(*effect.type)) || std::ranges::find(there, node) != there.end();
    });
  };
  for (auto next = std::ranges::find_if(waiting, is_there); next != waiting.end(); next = std::ranges::find_if(waiting, is_there)) {
    there.push_back(next->name);
    ordered.push_back(std::move(*next));
    waiting.erase(next);
  }
  for (const MotorEffect& effect : waiting) {
    table.problem(effect.name, "depends on a node that depends on this one; expected a chain that ends at winding, stator or ambient");
  }
  return ordered;
}

}  // namespace

std::size_t MotorEffect::column_place() const {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const std::span<const base::Choice> choices = type->parameters[i].choices;
    const auto chosen = static_cast<std::size_t>(parameters[i].value);
    if (!choices.empty() && thermal::is_column_choice(choices[chosen].name)) {
      return static_cast<std::size_t>(std::ranges::find(thermal::kColumnChoices, choices[chosen].name) - thermal::kColumnChoices.begin());
    }
  }
  return 0;
}

std::vector<double> MotorEffect::values() const {
  std::vector<double> all;
  std::ranges::transform(parameters, std::back_inserter(all), &base::ParameterValue::value);
  return all;
}

void read_effects(input::Reader& top, Motor& motor) {
  std::optional<input::Reader> table = top.table("effects", input::Need::optional);
  if (!table) {
    return;
  }
  std::vector<Entry> entries = entries_of(*table);
  for (Entry& entry : entries) {
    if (entry.sensor) {
      motor.sensors.push_back(
          {entry.name, entry.sensor, entry.reader.parameter(entry.sensor->size, input::Need::required).value_or(base::ParameterValue{})});
      entry.reader.finish();
    }
  }
  std::erase_if(entries, [](const Entry& entry) { return entry.sensor != nullptr; });
  std::vector<std::string> known(kNodes.begin(), kNodes.end());
  for (const Entry& entry : entries) {
    if (brings_node(*entry.type)) {
      known.push_back(entry.name);
    }
  }
  if (known.size() > thermal::Network::kMostNodes) {
    table->problem(known.back(),
                   fmt::format("is node number {}; expected at most {}, ambient among them", known.size(), thermal::Network::kMostNodes));
  }
  std::vector<MotorEffect> effects;
  std::vector<std::string> columns;
  bool sound = true;
  for (Entry& entry : entries) {
    MotorEffect effect{entry.name, entry.type, {}, {}, {}};
    read_nodes(entry, known, effect);
    read_parameters(entry.reader, *entry.type, effect);
    if (std::optional<input::Reader> condition = entry.reader.table("condition", input::Need::optional)) {
      for (const std::string& key : condition->keys()) {
        effect.condition.emplace(key, condition->text(key, input::Need::required).value_or(""));
      }
    }
    if (goes_with_column(effect)) {
      effect.column = entry.reader.text("column", input::Need::required).value_or("");
      if (effect.column.empty()) {
        entry.reader.problem("column",
                             "is not a column name; expected the name of a column of the logs with its unit, such as \"fan_ratio\"");
      } else if (effect.column.ends_with("_C")) {
        entry.reader.problem("column",
                             fmt::format("'{}' is a temperature; expected driver = \"temperature\" and watched = the node", effect.column));
      }
      if (!take_place(effect, columns)) {
        entry.reader.problem("column", fmt::format("is column number {} of this motor; expected at most {}: {}", columns.size() + 1,
                                                   thermal::kLogColumns, fmt::join(columns, ", ")));
      }
    }
    entry.reader.finish();
    const auto moves_loss = [](const MotorEffect& each) { return each.type->moves_copper_loss; };
    if (const auto first = std::ranges::find_if(effects, moves_loss); moves_loss(effect) && first != effects.end()) {
      table->problem(effect.name, fmt::format("moves copper loss, as effects.{} does; expected one such effect", first->name));
    }
    sound =
        sound && std::ranges::all_of(effect.nodes, [&](const std::string& node) { return std::ranges::find(known, node) != known.end(); });
    effects.push_back(std::move(effect));
  }
  table->finish();
  motor.effects = sound ? in_order(std::move(effects), *table) : std::move(effects);
}

}  // namespace heatsoak::motor
