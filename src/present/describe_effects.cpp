#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "base/quantity.h"
#include "motor/datasheet_network.h"
#include "present/description.h"
#include "present/motor_file_lines.h"
#include "present/parameter_table.h"

namespace heatsoak::present {
namespace {

constexpr std::string_view kAtTheEnd = "at the end of a motor file";

Table keys_table() {
  return {.title = "",
          .columns = {{"key", "", 0, Alignment::left}, {"unit", "", 0, Alignment::left}, {"meaning", "", 0, Alignment::left, 0, true}},
          .rows = {}};
}

void add_key(Table& table, std::string_view key, std::string_view unit, std::string meaning) {
  table.rows.push_back({{std::string(key)}, {std::string(unit)}, {std::move(meaning)}});
}

Table parameters_of(const thermal::EffectType& effect) {
  Table table = keys_table();
  for (const base::ParameterSpec& spec : effect.parameters) {
    const std::string unit =
        spec.unit_of ? fmt::format("as {}", effect.parameters[*spec.unit_of].key) : std::string(base::unit_for_display(spec.unit));
    add_key(table, spec.key, unit,
            fmt::format("{}; {}", spec.meaning, spec.choices.empty() ? base::to_string(spec.range, spec.unit) : "one of"));
    for (const base::Choice& choice : spec.choices) {
      if (choice.meaning.empty()) {
        continue;  // not for motor files
      }
      add_key(table, fmt::format("  {}", choice.name), base::unit_for_display(choice.unit), std::string(choice.meaning));
    }
  }
  for (const thermal::NodeRole& role : effect.nodes) {
    add_key(table, role.role, "node",
            role.own_capacity ? "own node, named after the effect in the file" : fmt::format("'{}' unless named", role.default_node));
  }
  return table;
}

}  // namespace

std::string signal_name(thermal::Signal signal) {
  std::string name(thermal::quantity_of(signal).name);
  std::ranges::replace(name, '_', ' ');
  return name;
}

Document effect_description(const thermal::EffectType& effect) {
  Document document{.headline = {{fmt::format("{}: {}", effect.name, effect.summary)}}, .paragraphs = {std::string(effect.equation)}};
  document.tables.push_back(parameters_of(effect));
  std::vector<std::string> needs;
  std::ranges::transform(effect.needs, std::back_inserter(needs), signal_name);
  const bool has_choice = std::ranges::any_of(effect.parameters, [](const base::ParameterSpec& spec) { return !spec.choices.empty(); });
  Table table = labelled_table("");
  add_labelled(table, "typical size", effect.typical);
  add_labelled(table, "confounded", effect.confounded_with);
  add_labelled(table, "needs a log of", has_choice ? "the signal that was chosen" : fmt::format("{}", fmt::join(needs, ", ")));
  if (effect.candidacy.size_parameter) {
    add_labelled(table, "family", effect.candidacy.family);
    add_labelled(table, "experiment", effect.candidacy.experiment);
  }
  add_labelled(table, "reference", effect.reference);
  document.tables.push_back(std::move(table));
  document.listings.push_back(
      {fmt::format("{}{}:", kAtTheEnd,
                   motor::is_loss_of_every_motor(effect) ? ", where it is added to the same loss of the file's own parameters" : ""),
       motor_file_lines(effect)});
  return document;
}

Document effect_outside_network(std::string_view where, std::string_view name, std::string_view summary, const base::ParameterSpec& size,
                                std::span<const LabelledWords> lines) {
  Document document{.headline = {{fmt::format("{}: {}", name, summary)}}, .paragraphs = {fmt::format("Place: {}.", where)}};
  Table keys = keys_table();
  add_key(keys, size.key, base::unit_for_display(size.unit), fmt::format("{}; {}", size.meaning, base::to_string(size.range, size.unit)));
  Table table = labelled_table("");
  for (const LabelledWords& each : lines) {
    add_labelled(table, each.label, each.words);
  }
  document.tables = {std::move(keys), std::move(table)};
  return document;
}

Document sensor_description(const motor::SensorEffectType& type) {
  const std::array lines{LabelledWords{"equation", std::string(type.equation)}, LabelledWords{"typical size", std::string(type.typical)},
                         LabelledWords{"confounded", std::string(type.confounded_with)},
                         LabelledWords{"experiment", std::string(type.experiment)},
                         LabelledWords{"reference", std::string(type.reference)}};
  Document document =
      effect_outside_network(fmt::format("reading of the sensor of {}", type.signal), type.name, type.summary, type.size, lines);
  document.paragraphs.emplace_back(
      "calibrate and diagnose allow for this error if the motor's file states it, and simulate adds it to the reading.");
  document.listings.push_back(
      {fmt::format("{}:", kAtTheEnd), effect_table(type.name) + typical_value(type.size.key, type.typical_size, type.size.unit)});
  return document;
}

}  // namespace heatsoak::present
