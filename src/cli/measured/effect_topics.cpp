#include "cli/measured/effect_topics.h"

#include <nlohmann/json.hpp>

#include "cli/effect_topic.h"
#include "estimation/run_deviation.h"
#include "present/measured/run_deviation.h"

namespace heatsoak::cli {

std::vector<Topic> effect_topics() {
  std::vector<Topic> topics;
  for (const estimation::RunDeviationType& type : estimation::all_run_deviations()) {
    topics.push_back({std::string(type.name), std::string(type.summary), [&type] { return present::run_deviation_description(type); },
                      [&type] { return present::run_deviation_json(type); }});
  }
  return topics;
}

}  // namespace heatsoak::cli
