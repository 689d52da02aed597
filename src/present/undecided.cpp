#include "present/undecided.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/lanes.h"
#include "present/verdict_words.h"
#include "select/decision.h"

namespace heatsoak::present {
namespace {

std::string_view unit_of(const select::MotorEvaluation& motor) { return motor.games > 0 ? "games" : "samples"; }

/// Fewer samples than the program draws by itself say little about the number that decides.
bool are_few(const select::MotorEvaluation& motor) { return motor.samples < select::first_samples(motor.games > 0); }

/// Returns how many more games or samples decide the verdict, with which probability.
std::string deciding_words(const select::MotorEvaluation& motor) {
  const bool is_drawn = motor.games > 0;
  const std::string_view unit = unit_of(motor);
  if (are_few(motor)) {
    const int usual = select::first_samples(is_drawn);
    return fmt::format("Without --samples, {} are drawn ({} more {}), and more if needed", usual,
                       is_drawn ? usual / base::kLanes - motor.games : usual - motor.samples, unit);
  }
  const int most = select::most_samples_at_all(is_drawn);
  const auto [half, nine_in_ten] = select::deciding_samples(motor);
  const auto number = [&](int samples) { return is_drawn ? samples / base::kLanes : samples; };
  const auto more = [&](int samples) { return number(samples) - (is_drawn ? motor.games : motor.samples); };
  if (!half) {
    return fmt::format("The share is close to the threshold: {} {}, the most that --samples takes ({}), will probably not decide",
                       number(most), unit, most);
  }
  return fmt::format("With a probability of {:.0f} % {} more {} decide (--samples {}), with {:.0f} % {}",
                     100.0 * select::kEvenDecision_share, more(*half), unit, *half, 100.0 * select::kLikelyDecision_share,
                     nine_in_ten ? fmt::format("{} more (--samples {})", more(*nine_in_ten), *nine_in_ten)
                                 : fmt::format("over {} (--samples takes {} at most)", number(most), most));
}

std::string note_on_one(const select::MotorEvaluation& motor) {
  return fmt::format("{} counts as {} until more {} decide: {}{}. {}.", motor.motor_id, select::to_string(motor.verdict), unit_of(motor),
                     motor.games > 0 ? fmt::format("in {} games ", motor.games) : "", words_of(*open_share(motor), motor.samples),
                     deciding_words(motor));
}

/// The motors that need the fewest samples come first; those that need equal numbers stand together.
std::string note_on_several(const std::vector<const select::MotorEvaluation*>& motors) {
  const int most = select::most_samples_at_all(motors.front()->games > 0);
  constexpr int kNever = std::numeric_limits<int>::max();
  std::map<std::pair<int, int>, std::vector<std::string>> ids;  // by the numbers of samples
  for (const select::MotorEvaluation* each : motors) {
    const auto [half, nine_in_ten] = select::deciding_samples(*each);
    ids[{half.value_or(kNever), nine_in_ten.value_or(kNever)}].push_back(each->motor_id);
  }
  const auto shown = [most](int samples) { return samples == kNever ? fmt::format("over {}", most) : fmt::format("{}", samples); };
  std::vector<std::string> words;
  for (const auto& [needs, of_needs] : ids) {
    const auto& [half, nine_in_ten] = needs;
    words.push_back(fmt::format("{}{} for {}", shown(half), half == kNever ? "" : fmt::format(" to {}", shown(nine_in_ten)),
                                fmt::join(of_needs, ", ")));
  }
  return fmt::format(
      "{} motors are undecided: after so few {}, the share of motors over a limit, or short of the demand, may lie on either side of a "
      "threshold. {}.",
      motors.size(), unit_of(*motors.front()),
      are_few(*motors.front())
          ? deciding_words(*motors.front())
          : fmt::format("Values of --samples that decide with a probability of {:.0f} % to {:.0f} %: {}",
                        100.0 * select::kEvenDecision_share, 100.0 * select::kLikelyDecision_share, fmt::join(words, "; ")));
}

}  // namespace

std::string needed_words(const select::MotorEvaluation& motor) {
  const bool is_drawn = motor.games > 0;
  const std::optional<int> half = are_few(motor) ? select::first_samples(is_drawn) : select::deciding_samples(motor).half;
  if (!half) {
    return fmt::format("more {} will hardly decide", unit_of(motor));
  }
  const int more = *half - motor.samples;
  return fmt::format("about {} more {} needed", is_drawn ? more / base::kLanes : more, unit_of(motor));
}

void add_undecided_note(Document& document, std::span<const select::MotorEvaluation> results) {
  std::vector<const select::MotorEvaluation*> undecided;
  for (const select::MotorEvaluation& each : results) {
    if (each.samples_needed) {
      undecided.push_back(&each);
    }
  }
  if (undecided.empty()) {
    return;
  }
  std::string words = undecided.size() == 1 ? note_on_one(*undecided.front()) : note_on_several(undecided);
  document.add_note(Severity::warning, words);
}

}  // namespace heatsoak::present
