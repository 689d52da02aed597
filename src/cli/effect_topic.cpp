#include "cli/effect_topic.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <nlohmann/json.hpp>

#include "motor/sensor_effect.h"
#include "present/description.h"

namespace heatsoak {
namespace {

Topic sensor_topic(const SensorEffectType& type) {
  return {std::string(type.name), std::string(type.summary), [&type] { return present::sensor_description(type); },
          [&type] {
            const std::array lines{TopicLine{"equation", type.equation}, TopicLine{"typical", type.typical},
                                   TopicLine{"look_alike", type.confounded_with}, TopicLine{"experiment", type.experiment},
                                   TopicLine{"reference", type.reference}};
            return effect_json(fmt::format("reading of the sensor of {}", type.signal), type.name, type.summary, type.size, lines);
          }};
}

}  // namespace

nlohmann::ordered_json effect_json(std::string_view where, std::string_view name, std::string_view summary, const ParameterSpec& size,
                                   std::span<const TopicLine> lines) {
  nlohmann::ordered_json json{{"kind", "effect"}, {"id", name}, {"summary", summary}, {"where", where}};
  json["parameters"].push_back({{"key", size.key}, {"unit", size.unit}, {"meaning", size.meaning}});
  for (const auto& [key, words] : lines) {
    if (!words.empty()) {
      json[std::string(key)] = words;
    }
  }
  return json;
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
