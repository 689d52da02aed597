#include "cli/threshold_topic.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "check/threshold.h"
#include "present/description.h"
#include "present/description_json.h"

namespace heatsoak::cli {
namespace {

Topic topic_of(const check::ThresholdType& type) {
  Topic topic;
  topic.id = type.name;
  topic.summary = fmt::format("\"{}\": {}", type.example, type.meaning.substr(0, type.meaning.find_first_of(":;,(")));
  topic.document = [&type] { return present::threshold_description(type); };
  topic.json = [&type] { return present::threshold_json(type); };
  return topic;
}

}  // namespace

std::vector<Topic> threshold_topics() {
  std::vector<Topic> topics{{.id = "command",
                             .summary = "\"at most 1.9\": any number of the JSON answer of a command of this program",
                             .document = present::command_limits_description,
                             .json = present::command_limits_json}};
  for (const check::ThresholdType& type : check::all_thresholds()) {
    topics.push_back(topic_of(type));
  }
  return topics;
}

}  // namespace heatsoak::cli
