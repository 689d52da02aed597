#include "cli/effect_topic.h"

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "motor/sensor_effect.h"
#include "present/description.h"
#include "present/description_json.h"

namespace heatsoak::cli {
namespace {

Topic sensor_topic(const motor::SensorEffectType& type) {
  return {std::string(type.name), std::string(type.summary), [&type] { return present::sensor_description(type); },
          [&type] { return present::sensor_json(type); }};
}

}  // namespace

std::vector<Topic> all_topics() {
  std::vector<Topic> topics;
  std::ranges::transform(motor::all_sensor_effects(), std::back_inserter(topics), sensor_topic);
  for (const Command& command : all_commands()) {
    if (command.topics) {
      std::ranges::move(command.topics(), std::back_inserter(topics));
    }
  }
  return topics;
}

}  // namespace heatsoak::cli
