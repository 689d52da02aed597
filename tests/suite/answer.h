#pragma once
// Answers of `heatsoak diagnose`, and what is right in them.
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace heatsoak::suite {

/// A motor's truth and the answer of the program. Without an answer (crash, refusal) `answer` is null.
struct Answer {
  std::string motor;
  nlohmann::json truth;
  nlohmann::json answer;
  int exit_code = 0;
  double wall_s = 0.0;

  bool exists() const { return answer.is_object() && answer.contains("verdict"); }
  std::string group() const { return truth.value("group", ""); }
  std::string verdict() const { return exists() ? answer.value("verdict", "") : "no answer"; }
};

/// Reads truths, answers and records of runs. Motors without a record have not been run and are left out.
std::vector<Answer> load_answers(const std::filesystem::path& data, const std::filesystem::path& answers, const std::string& only);

/// One statement of an answer: a name (or several that the runs do not distinguish), or a curve over signals.
struct Term {
  std::vector<std::string> names;  ///< the first is the answer's own, the others are those that it is confusable with
  std::string node;
  std::vector<std::string> signals;  ///< input signals of a curve, in the suite's words; empty for a named effect

  bool is_curve() const { return !signals.empty(); }
  bool is_class() const { return names.size() > 1; }
};

/// Terms in the order of the answer: the effects, then a curve of `unexplained` that is not among them.
std::vector<Term> terms_of(const Answer& answer);

/// The suite's word for an input signal: speed, current, power, acceleration, vehicle_speed, fan, neighbour, modulation, bus, winding,
/// stator, ambient, time.
std::string signal_word(const std::string& name_in_answer);

/// True effect of a motor.
struct TrueEffect {
  std::string id;
  std::string node;
  std::vector<std::string> family;
  std::vector<std::string> signals;
  bool is_visible = false;
};
std::vector<TrueEffect> true_effects(const Answer& answer);

/// Agreement between a term and an effect, from none to the best.
enum class Match { kNone, kCurve, kClass, kName };

/// Returns kName if the answer's own name is of the family, kClass if only another name of its class is, kCurve if it is a curve over
/// signals of the effect at the effect's node.
Match match_of(const Term& term, const TrueEffect& effect);

/// Best match of any true effect.
Match match_of(const Term& term, const std::vector<TrueEffect>& effects);

/// True if a name of the term is in `truth.present`. A curve is present if it states a true effect.
bool is_present(const Term& term, const Answer& answer);

/// RMS error of one sensor in the hold-out runs, for the model named by a key of the answer: before, refitted or after.
std::optional<double> holdout_rmse_K(const Answer& answer, const std::string& model, const std::string& sensor);

/// True if the error of either sensor after the diagnosis exceeds that of the other model by 0.1 K and 5 %. Empty if the answer lacks one.
std::optional<bool> error_grows(const Answer& answer, const std::string& other_model);

/// Shares of readings within the 90 % band after the diagnosis, one per hold-out run and sensor.
std::vector<double> coverage_shares(const Answer& answer);

}  // namespace heatsoak::suite
