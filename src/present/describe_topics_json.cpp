#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "firmware/core_diagram.h"
#include "present/description.h"
#include "present/description_json.h"
#include "present/verdict_topic.h"

namespace heatsoak::present {
namespace {

Json keys_of(const std::vector<check::Setting>& settings) {
  Json keys = Json::array();
  for (const check::Setting setting : settings) {
    keys.push_back(check::all_settings()[static_cast<std::size_t>(setting)].key);
  }
  return keys;
}

}  // namespace

Json network_effect_json(const thermal::EffectType& effect) {
  Json result{{"kind", "effect"},
              {"id", effect.name},
              {"summary", effect.summary},
              {"equation", effect.equation},
              {"reference", effect.reference},
              {"typical", effect.typical},
              {"look_alike", effect.confounded_with}};
  for (const base::ParameterSpec& spec : effect.parameters) {
    Json json{{"key", spec.key}, {"unit", spec.unit}, {"meaning", spec.meaning}};
    for (const base::Choice& choice : spec.choices) {
      if (choice.meaning.empty()) {
        continue;  // not for motor files
      }
      json["choices"].push_back({{"name", choice.name}, {"unit", choice.unit}, {"meaning", choice.meaning}});
    }
    result["parameters"].push_back(json);
  }
  for (const thermal::NodeRole& role : effect.nodes) {
    result["nodes"].push_back({{"key", role.role}, {"default", role.own_capacity ? Json() : Json(role.default_node)}});
  }
  result["needs"] = Json::array();
  for (const thermal::Signal signal : effect.needs) {
    result["needs"].push_back(signal_name(signal));
  }
  if (effect.candidacy.size_parameter) {
    result["family"] = effect.candidacy.family;
    result["experiment"] = effect.candidacy.experiment;
  }
  return result;
}

Json effect_outside_network_json(std::string_view where, std::string_view name, std::string_view summary, const base::ParameterSpec& size,
                                 std::span<const TopicLine> lines) {
  Json json{{"kind", "effect"}, {"id", name}, {"summary", summary}, {"where", where}};
  json["parameters"].push_back({{"key", size.key}, {"unit", size.unit}, {"meaning", size.meaning}});
  for (const auto& [key, words] : lines) {
    if (!words.empty()) {
      json[std::string(key)] = words;
    }
  }
  return json;
}

Json sensor_json(const motor::SensorEffectType& type) {
  const std::array lines{TopicLine{"equation", type.equation}, TopicLine{"typical", type.typical},
                         TopicLine{"look_alike", type.confounded_with}, TopicLine{"experiment", type.experiment},
                         TopicLine{"reference", type.reference}};
  return effect_outside_network_json(fmt::format("reading of the sensor of {}", type.signal), type.name, type.summary, type.size, lines);
}

Json threshold_json(const check::ThresholdType& type) {
  return {{"kind", "threshold"},
          {"id", type.name},
          {"unit", type.unit},
          {"direction", type.direction == check::Bound::at_most ? "at_most" : "at_least"},
          {"meaning", type.meaning},
          {"example", type.example},
          {"needs", keys_of(type.needs)},
          {"takes", keys_of(type.takes)}};
}

Json command_limits_json() {
  return {{"kind", "threshold"},
          {"id", "command"},
          {"meaning", "any number of the JSON answer of the check's command"},
          {"needs", keys_of({check::Setting::command})}};
}

Json verdict_json() {
  Json meanings = Json::array();
  for (const VerdictMeaning& each : verdict_meanings()) {
    meanings.push_back({{"verdict", select::to_string(each.verdict)}, {"meaning", each.meaning}});
  }
  return {{"kind", "verdict"}, {"id", "verdict"}, {"verdicts", meanings}};
}

Json core_json() {
  Json result{{"kind", "core"}, {"id", "robot_core"}};
  for (const robot_core::BlockText& block : robot_core::kBlocks) {
    result["blocks"].push_back({{"number", block.number},
                                {"function", block.function},
                                {"files", block.files},
                                {"title", block.title},
                                {"task", block.task},
                                {"rate", firmware::rate_words(block.rate)}});
  }
  for (const robot_core::SignalText& signal : robot_core::kSignals) {
    const bool is_input = signal.from == robot_core::Block::firmware;
    result["signals"].push_back({{"carrier", signal.carrier},
                                 {"name", signal.name},
                                 {"unit", signal.unit},
                                 {"from", is_input ? "firmware" : firmware::text_of(signal.from).number},
                                 {"to", firmware::numbers_of(signal.to)}});
  }
  return result;
}

}  // namespace heatsoak::present
