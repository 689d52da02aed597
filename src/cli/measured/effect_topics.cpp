#include "cli/measured/effect_topics.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/quantity.h"
#include "identify/attribution/run_deviation.h"
#include "identify/sensor_effect.h"

namespace heatsoak {
namespace {

struct Line {
  std::string_view key;    ///< of the JSON, as for the network's effects
  std::string_view label;  ///< for people
  std::string words;
};

Topic topic(std::string_view kind, std::string_view name, std::string_view summary, const ParameterSpec& size,
            const std::vector<Line>& lines) {
  nlohmann::ordered_json json{{"kind", "effect"}, {"id", name}, {"summary", summary}, {"where", kind}};
  json["parameters"].push_back({{"key", size.key}, {"unit", size.unit}, {"meaning", size.meaning}});
  std::string text = fmt::format("{}: {}\n  {}; found by diagnose, no part of a motor file\n\n  {:24} {:10} {}; {}\n\n", name, summary,
                                 kind, size.key, unit_for_display(size.unit), size.meaning, to_string(size.range, size.unit));
  for (const auto& [key, label, words] : lines) {
    if (!words.empty()) {
      text += fmt::format("  {:14} {}\n", label, words);
      json[std::string(key)] = words;
    }
  }
  return {std::string(name), std::string(summary), std::move(text), [json] { return json; }};
}

std::string in_units(double value, std::string_view unit) {
  return fmt::format("{}{}{}", significant(value, 3), unit.empty() ? "" : " ", unit_for_display(unit));
}

}  // namespace

std::vector<Topic> effect_topics() {
  std::vector<Topic> topics;
  for (const SensorEffectType& type : all_sensor_effects()) {
    topics.push_back(topic(fmt::format("what the sensor of {} shows", type.signal), type.name, type.summary, type.size,
                           {{"equation", "equation", std::string(type.equation)},
                            {"typical", "typical size", std::string(type.typical)},
                            {"look_alike", "look-alikes", std::string(type.look_alike)},
                            {"experiment", "to tell apart", std::string(type.experiment)},
                            {"reference", "reference", std::string(type.reference)}}));
  }
  for (const RunDeviationType& type : all_run_deviations()) {
    topics.push_back(topic(fmt::format("at the {}, in runs of one condition", type.node), type.name, type.summary, type.size,
                           {{"equation", "equation", std::string(type.equation)},
                            {"typical", "typical size", in_units(type.usual, type.size.unit)},
                            {"look_alike", "look-alikes", std::string(type.look_alike)},
                            {"experiment", "to tell apart", std::string(type.experiment)}}));
  }
  return topics;
}

}  // namespace heatsoak
