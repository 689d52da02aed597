#include "cli/effect_topic.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <nlohmann/json.hpp>

#include "base/quantity.h"
#include "motor/sensor_effect.h"

namespace heatsoak {
namespace {

Topic sensor_topic(const SensorEffectType& type) {
  const std::array lines{TopicLine{"equation", "equation", std::string(type.equation)},
                         TopicLine{"typical", "typical size", std::string(type.typical)},
                         TopicLine{"look_alike", "confounded", std::string(type.confounded_with)},
                         TopicLine{"experiment", "experiment", std::string(type.experiment)},
                         TopicLine{"reference", "reference", std::string(type.reference)}};
  const std::string use = fmt::format(
      "\nat the end of a motor file; calibrate and diagnose then allow for this error, and simulate adds it to the reading:\n{}{}",
      effect_table(type.name), typical_value(type.size.key, type.typical_size, type.size.unit));
  return effect_topic(fmt::format("reading of the sensor of {}", type.signal), type.name, type.summary, type.size, lines, use);
}

}  // namespace

Topic effect_topic(std::string_view where, std::string_view name, std::string_view summary, const ParameterSpec& size,
                   std::span<const TopicLine> lines, std::string_view use) {
  nlohmann::ordered_json json{{"kind", "effect"}, {"id", name}, {"summary", summary}, {"where", where}};
  json["parameters"].push_back({{"key", size.key}, {"unit", size.unit}, {"meaning", size.meaning}});
  std::string text = fmt::format("{}: {}\n  {}\n\n  {:24} {:10} {}; {}\n\n", name, summary, where, size.key, unit_for_display(size.unit),
                                 size.meaning, to_string(size.range, size.unit));
  for (const auto& [key, label, words] : lines) {
    if (!words.empty()) {
      text += fmt::format("  {:14} {}\n", label, words);
      json[std::string(key)] = words;
    }
  }
  text += use;
  return {std::string(name), std::string(summary), std::move(text), [json] { return json; }};
}

std::string effect_table(std::string_view type_name) { return fmt::format("[effects.my_{}]\ntype = \"{}\"\n", type_name, type_name); }

std::string typical_value(std::string_view key, double value, std::string_view unit) {
  return fmt::format("{} = {{ value = \"{}{}{}\", origin = \"estimated\", derivation = \"typical size\" }}\n", key, significant(value, 6),
                     unit.empty() ? "" : " ", unit);
}

std::vector<Topic> all_topics() {
  std::vector<Topic> topics;
  std::ranges::transform(all_sensor_effects(), std::back_inserter(topics), sensor_topic);
  for (const Command& command : all_commands()) {
    if (command.topics) {
      std::ranges::move(command.topics(), std::back_inserter(topics));
    }
  }
  return topics;
}

}  // namespace heatsoak
