#include "cli/threshold_topic.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "check/threshold.h"

namespace heatsoak {
namespace {

const SettingText& text_of(Setting setting) { return all_settings()[static_cast<std::size_t>(setting)]; }

std::string settings_text(std::string_view what, const std::vector<Setting>& settings) {
  std::string text = settings.empty() ? std::string() : fmt::format("\n{}\n", what);
  for (const Setting setting : settings) {
    text += fmt::format("  {:12} {}\n", text_of(setting).key, text_of(setting).meaning);
  }
  return text;
}

nlohmann::ordered_json keys_of(const std::vector<Setting>& settings) {
  nlohmann::ordered_json keys = nlohmann::ordered_json::array();
  for (const Setting setting : settings) {
    keys.push_back(text_of(setting).key);
  }
  return keys;
}

std::string example_of(const ThresholdType& type) {
  std::string text = "\n[[check]]\nname = \"what this check is for\"\n";
  for (const Setting setting : type.needs) {
    const std::string_view key = text_of(setting).key;
    text += setting == Setting::temperature                           ? fmt::format("{} = \"100 degC\"\n", key)
            : setting == Setting::against || setting == Setting::logs ? fmt::format("{} = [\"…\", \"…\"]\n", key)
                                                                      : fmt::format("{} = \"…\"\n", key);
  }
  return text + fmt::format("[check.limits]\n{} = \"{}\"\n", type.name, type.example);
}

Topic topic_of(const ThresholdType& type) {
  Topic topic;
  topic.id = type.name;
  topic.summary = fmt::format("\"{}\": {}", type.example, type.meaning.substr(0, type.meaning.find_first_of(":;,(")));
  topic.text = fmt::format("{}: a threshold of `heatsoak check`, such as \"{}\"\n\n{}\n{}{}{}", type.name, type.example, type.meaning,
                           settings_text("needs in the check", type.needs), settings_text("takes besides", type.takes), example_of(type));
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
