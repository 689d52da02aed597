#include "estimation/run_deviation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace heatsoak::estimation {
namespace {

bool turns_input_into_heat(const thermal::Network& /*network*/, const thermal::EffectInPlace& effect) {
  return effect.type->name == "copper_loss" || effect.type->name == "input_power_loss";
}

bool is_resistance_to_ambient(const thermal::Network& network, const thermal::EffectInPlace& effect) {
  return effect.type->name == "conduction" &&
         std::ranges::any_of(effect.node_index, [&](int node) { return network.node_name(node) == thermal::Network::kAmbient; });
}

bool is_contact(const thermal::Network& network, const thermal::EffectInPlace& effect) {
  return effect.type->name == "conduction" && !is_resistance_to_ambient(network, effect);
}

}  // namespace

const std::vector<RunDeviationType>& all_run_deviations() {
  static const std::vector<RunDeviationType> all{
      {.name = "heat_share",
       .size = {"deviation", "", base::Range::between(-0.9, 3.0), "relative deviation of the heat input from the logged value"},
       .usual = 0.1,
       .node = "winding",
       .summary = "The heat input differs from the log: another phase carries the current, or the motor driver takes another share.",
       .equation = "P_in = (1 + deviation) · P_in of the log",
       .family = "heat input that differs from the log",
       .confounded_with = "constant_heat in that run if the load hardly changes; airflow at the winding, with the opposite sign.",
       .experiment =
           "current and voltage measured at the motor's own terminals, with the rotor turned by a sixth of an electrical turn between runs",
       .concerns = turns_input_into_heat,
       .part_ratio = [](double d_share) { return d_share / std::max(0.01, 1.0 + d_share); }},
      {.name = "hindered_cooling",
       .size = {"resistance_rise", "", base::Range::between(0.0, 20.0), "relative increase of the resistance to ambient"},
       .usual = 0.3,
       .node = "stator",
       .summary = "Less heat leaves than the model predicts: a cover, a loose mount, or a missing fan or draught.",
       .equation = "R_ambient = (1 + resistance_rise) · R_ambient of the other runs",
       .family = "less cooling than usual",
       .confounded_with = "airflow in all the other runs.",
       .experiment = "the same load twice: with mount and cover as in that run, and as intended",
       .concerns = is_resistance_to_ambient,
       .part_ratio = [](double d_share) { return -d_share; }},
      {.name = "changed_contact",
       .size = {"resistance_change", "", base::Range::between(-0.9, 20.0), "relative change of the resistance between winding and stator"},
       .usual = 0.2,
       .node = "winding",
       .summary =
           "The contact between winding and stator conducts worse or better than in the model: the winding came loose, or was glued.",
       .equation = "R_contact = (1 + resistance_change) · R_contact of the other runs",
       .family = "contact between winding and stator",
       .confounded_with = "contact_ageing and contact_temperature_dependence, if that run has another age or temperature.",
       .experiment = "the same locked-rotor run again, from equal start temperatures",
       .concerns = is_contact,
       .part_ratio = [](double d_share) { return -d_share; }},
  };
  return all;
}

std::vector<int> RunDeviationType::places_in(const thermal::Network& network) const {
  std::vector<int> places;
  for (const thermal::EffectInPlace& effect : network.effects()) {
    if (concerns(network, effect)) {
      places.push_back(effect.parameter_index.front());
    }
  }
  return places;
}

std::string in_words(const Condition& condition) {
  std::string text;
  for (const auto& [key, value] : condition) {
    text += fmt::format("{}{}", text.empty() ? "" : ",", key == "run" ? value : fmt::format("{}={}", key, value));
  }
  return text;
}

std::vector<Condition> same_as(const Condition& condition, std::span<const MeasuredRun> runs) {
  std::vector<Condition> all;
  for (const MeasuredRun& run : runs) {
    for (const auto& [key, value] : run.conditions) {
      const Condition other{{key, value}};
      const bool is_same = std::ranges::all_of(runs, [&](const MeasuredRun& each) { return each.has(other) == each.has(condition); });
      if (is_same && key != "run" && !condition.contains(key) && std::ranges::find(all, other) == all.end()) {
        all.push_back(other);
      }
    }
  }
  return all;
}

bool are_related(const Condition& a, const Condition& b, std::span<const MeasuredRun> runs) {
  if (a.empty() || b.empty()) {
    return a == b;
  }
  const auto is_key_of_b = [&](const auto& part) { return part.first != "run" && b.contains(part.first); };
  const bool have_same_keys = a.size() == b.size() && std::ranges::all_of(a, is_key_of_b);
  return a == b || have_same_keys || std::ranges::none_of(runs, [&](const MeasuredRun& run) { return run.has(a) == run.has(b); });
}

std::vector<Condition> conditions_of(std::span<const MeasuredRun> runs) {
  std::vector<Condition> conditions;
  std::vector<std::vector<bool>> known;
  for (const bool named : {false, true}) {
    for (const MeasuredRun& each : runs) {
      for (const auto& [key, value] : each.conditions) {
        const Condition condition{{key, value}};
        std::vector<bool> has;
        for (const MeasuredRun& run : runs) {
          has.push_back(run.has(condition));
        }
        const bool parts = std::ranges::find(has, false) != has.end();
        if ((key == "run") == named && parts && std::ranges::find(known, has) == known.end()) {
          known.push_back(std::move(has));
          conditions.push_back(condition);
        }
      }
    }
  }
  return conditions;
}

}  // namespace heatsoak::estimation
