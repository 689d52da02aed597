#include "answer.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>

#include "run_program.h"

namespace heatsoak::suite {
namespace {

nlohmann::json json_in(const std::filesystem::path& path) {
  std::ifstream file(path);
  return file ? nlohmann::json::parse(file, nullptr, false) : nlohmann::json();
}

std::vector<std::string> strings_in(const nlohmann::json& parent, const std::string& key) {
  std::vector<std::string> words;
  if (parent.contains(key) && parent[key].is_array()) {
    for (const nlohmann::json& word : parent[key]) {
      if (word.is_string()) {
        words.push_back(word.get<std::string>());
      }
    }
  }
  return words;
}

std::string string_in(const nlohmann::json& parent, const std::string& key) {
  return parent.contains(key) && parent[key].is_string() ? parent[key].get<std::string>() : "";
}

std::vector<std::string> signal_words(const std::vector<std::string>& names) {
  std::vector<std::string> words;
  for (const std::string& name : names) {
    words.push_back(signal_word(name));
  }
  return words;
}

bool contains(const std::vector<std::string>& all, const std::string& word) { return std::ranges::find(all, word) != all.end(); }

const nlohmann::json* child(const nlohmann::json& parent, const std::vector<std::string>& path) {
  const nlohmann::json* at = &parent;
  for (const std::string& key : path) {
    if (!at->is_object() || !at->contains(key)) {
      return nullptr;
    }
    at = &(*at)[key];
  }
  return at;
}

constexpr std::array<const char*, 2> kSensors{"winding_C", "stator_C"};

}  // namespace

std::vector<Answer> load_answers(const std::filesystem::path& data, const std::filesystem::path& answers, const std::string& only) {
  std::vector<Answer> all;
  for (const std::string& motor : motors_in(data, only)) {
    const nlohmann::json record = json_in(answers / (motor + ".run.json"));
    if (!record.is_object()) {
      continue;
    }
    Answer answer{.motor = motor,
                  .truth = json_in(data / motor / "truth.json"),
                  .answer = json_in(answers / (motor + ".json")),
                  .exit_code = record.value("exit_code", -1),
                  .wall_s = record.value("wall_s", 0.0)};
    if (!is_answer(answer.exit_code)) {
      answer.answer = nullptr;
    }
    all.push_back(std::move(answer));
  }
  return all;
}

std::string signal_word(const std::string& name_in_answer) {
  std::string lower;
  for (const char c : name_in_answer) {
    lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  const auto has = [&](const char* word) { return lower.find(word) != std::string::npos; };
  for (const char* word : {"vehicle_speed", "vehicle", "fan", "neighbour", "modulation", "acceleration", "bus"}) {
    if (has(word)) {
      return word == std::string("vehicle") ? "vehicle_speed" : word;
    }
  }
  if (has("duty")) {
    return "modulation";
  }
  if (has("velocity")) {
    return "speed";  // with its sign
  }
  if (has("power") || (has("current") && has("speed")) || has("torque")) {
    return "power";
  }
  for (const char* word : {"current", "speed", "winding", "stator", "ambient", "time"}) {
    if (has(word)) {
      return word;
    }
  }
  return lower;
}

std::vector<Term> terms_of(const Answer& answer) {
  std::vector<Term> terms;
  if (!answer.exists()) {
    return terms;
  }
  if (answer.answer.contains("effects") && answer.answer["effects"].is_array()) {
    for (const nlohmann::json& effect : answer.answer["effects"]) {
      if (!effect.is_object()) {
        continue;
      }
      Term term{
          .names = {string_in(effect, "id")}, .node = string_in(effect, "node"), .signals = signal_words(strings_in(effect, "drivers"))};
      for (const std::string& other : strings_in(effect, "confusable_with")) {
        term.names.push_back(other);
      }
      terms.push_back(std::move(term));
    }
  }
  if (const nlohmann::json* unexplained = child(answer.answer, {"unexplained"}); unexplained != nullptr && unexplained->is_object()) {
    const Term term{
        .names = {"unexplained"}, .node = string_in(*unexplained, "node"), .signals = signal_words(strings_in(*unexplained, "drivers"))};
    const bool is_listed = std::ranges::any_of(terms, [&](const Term& other) { return other.is_curve() && other.signals == term.signals; });
    if (term.is_curve() && !is_listed) {
      terms.push_back(term);
    }
  }
  return terms;
}

std::vector<TrueEffect> true_effects(const Answer& answer) {
  std::vector<TrueEffect> effects;
  if (answer.truth.contains("effects")) {
    for (const nlohmann::json& effect : answer.truth["effects"]) {
      effects.push_back({.id = string_in(effect, "id"),
                         .node = string_in(effect, "node"),
                         .family = strings_in(effect, "family"),
                         .signals = strings_in(effect, "signals"),
                         .is_visible = effect.value("visible", false)});
    }
  }
  return effects;
}

Match match_of(const Term& term, const TrueEffect& effect) {
  if (term.is_curve()) {
    const bool has_signal = std::ranges::any_of(term.signals, [&](const std::string& signal) { return contains(effect.signals, signal); });
    return has_signal && term.node == effect.node ? Match::kCurve : Match::kNone;
  }
  if (contains(effect.family, term.names.front())) {
    return Match::kName;
  }
  const bool in_class = std::ranges::any_of(term.names, [&](const std::string& name) { return contains(effect.family, name); });
  return in_class ? Match::kClass : Match::kNone;
}

Match match_of(const Term& term, const std::vector<TrueEffect>& effects) {
  Match best = Match::kNone;
  for (const TrueEffect& effect : effects) {
    best = std::max(best, match_of(term, effect));
  }
  return best;
}

bool is_present(const Term& term, const Answer& answer) {
  if (term.is_curve()) {
    return match_of(term, true_effects(answer)) == Match::kCurve;
  }
  const std::vector<std::string> present = strings_in(answer.truth, "present");
  return std::ranges::any_of(term.names, [&](const std::string& name) { return contains(present, name); });
}

std::optional<double> holdout_rmse_K(const Answer& answer, const std::string& model, const std::string& sensor) {
  const nlohmann::json* value = child(answer.answer, {model, "holdout", sensor, "rmse_K"});
  return value != nullptr && value->is_number() ? std::optional(value->get<double>()) : std::nullopt;
}

std::optional<bool> error_grows(const Answer& answer, const std::string& other_model) {
  bool grows = false;
  for (const char* sensor : kSensors) {
    const auto after_K = holdout_rmse_K(answer, "after", sensor);
    const auto other_K = holdout_rmse_K(answer, other_model, sensor);
    if (!after_K || !other_K) {
      return std::nullopt;
    }
    grows = grows || (*after_K > *other_K + 0.1 && *after_K > 1.05 * *other_K);
  }
  return grows;
}

std::vector<double> coverage_shares(const Answer& answer) {
  std::vector<double> shares;
  const nlohmann::json* runs = child(answer.answer, {"runs", "holdout", "after"});
  if (runs == nullptr || !runs->is_array()) {
    return shares;
  }
  for (const nlohmann::json& run : *runs) {
    for (const char* sensor : kSensors) {
      if (const nlohmann::json* share = child(run, {"coverage_90", sensor}); share != nullptr && share->is_number()) {
        shares.push_back(share->get<double>());
      }
    }
  }
  return shares;
}

}  // namespace heatsoak::suite
