#include "cli/threshold_topic.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "check/threshold.h"
#include "present/description.h"

namespace heatsoak {
namespace {

nlohmann::ordered_json keys_of(const std::vector<Setting>& settings) {
  nlohmann::ordered_json keys = nlohmann::ordered_json::array();
  for (const Setting setting : settings) {
    keys.push_back(all_settings()[static_cast<std::size_t>(setting)].key);
  }
  return keys;
}

Topic topic_of(const ThresholdType& type) {
  Topic topic;
  topic.id = type.name;
  topic.summary = fmt::format("\"{}\": {}", type.example, type.meaning.substr(0, type.meaning.find_first_of(":;,(")));
  topic.document = [&type] { return present::threshold_description(type); };
  topic.json = [&type] {
    return nlohmann::ordered_json{{"kind", "threshold"},
                                  {"id", type.name},
                                  {"unit", type.unit},
                                  {"direction", type.direction == Bound::at_most ? "at_most" : "at_least"},
                                  {"meaning", type.meaning},
                                  {"example", type.example},
                                  {"needs", keys_of(type.needs)},
                                  {"takes", keys_of(type.takes)}};
  };
  return topic;
}

}  // namespace

std::vector<Topic> threshold_topics() {
  std::vector<Topic> topics;
  for (const ThresholdType& type : all_thresholds()) {
    topics.push_back(topic_of(type));
  }
  return topics;
}

}  // namespace heatsoak
