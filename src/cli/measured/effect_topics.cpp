#include "cli/measured/effect_topics.h"

#include <fmt/format.h>

#include <array>

#include "attribution/run_deviation.h"
#include "base/quantity.h"
#include "cli/effect_topic.h"

namespace heatsoak {
namespace {

std::string in_units(double value, std::string_view unit) {
  return fmt::format("{}{}{}", significant(value, 3), unit.empty() ? "" : " ", unit_for_display(unit));
}

}  // namespace

std::vector<Topic> effect_topics() {
  std::vector<Topic> topics;
  for (const RunDeviationType& type : all_run_deviations()) {
    const std::array lines{TopicLine{"equation", "equation", std::string(type.equation)},
                           TopicLine{"typical", "typical size", in_units(type.usual, type.size.unit)},
                           TopicLine{"look_alike", "confounded", std::string(type.confounded_with)},
                           TopicLine{"experiment", "experiment", std::string(type.experiment)}};
    topics.push_back(effect_topic(fmt::format("at the {}, in runs of one condition", type.node), type.name, type.summary, type.size, lines,
                                  "\nfound by diagnose, not part of a motor file\n"));
  }
  return topics;
}

}  // namespace heatsoak
