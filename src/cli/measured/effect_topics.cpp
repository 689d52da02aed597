#include "cli/measured/effect_topics.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "attribution/run_deviation.h"
#include "cli/effect_topic.h"
#include "present/measured/run_deviation.h"

namespace heatsoak {

std::vector<Topic> effect_topics() {
  std::vector<Topic> topics;
  for (const RunDeviationType& type : all_run_deviations()) {
    topics.push_back({std::string(type.name), std::string(type.summary), [&type] { return present::run_deviation_description(type); },
                      [&type] {
                        const std::string typical = present::typical_size(type);
                        const std::array lines{TopicLine{"equation", type.equation}, TopicLine{"typical", typical},
                                               TopicLine{"look_alike", type.confounded_with}, TopicLine{"experiment", type.experiment}};
                        return effect_json(present::place_of(type), type.name, type.summary, type.size, lines);
                      }});
  }
  return topics;
}

}  // namespace heatsoak
