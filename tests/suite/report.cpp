// Tables of the score.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "score.h"

namespace heatsoak::suite {
namespace {

std::string share_row(const std::string& name, int hits, int count) {
  if (count == 0) {
    return fmt::format("| {} | – | |\n", name);
  }
  const auto [low, high] = wilson_interval(hits, count);
  return fmt::format("| {} | {}/{} | {:.0f} to {:.0f} % |\n", name, hits, count, 100.0 * low, 100.0 * high);
}

std::string count_row(const std::string& name, int count) { return fmt::format("| {} | {} | |\n", name, count); }

std::string scores_table(const Score& s) {
  std::string text = "| score | count | 95 % interval of the share |\n|---|---|---|\n";
  text += share_row("nothing missing: false alarms (name, curve or input signal)", s.nulls_false_alarm, s.nulls);
  text += share_row("nothing missing: verdict `unexplained`", s.nulls_unexplained, s.nulls);
  text += share_row("visible singles: named (any term)", s.singles_named, s.singles);
  text += share_row("visible singles: right family", s.singles_right, s.singles);
  text += share_row("visible singles: right family, of those named", s.singles_right, s.singles_named);
  text += share_row("visible singles: exact name", s.singles_exact, s.singles);
  text += count_row("visible singles: right only as a member of a class", s.singles_by_class);
  text += count_row("visible singles: only a curve over the right signal at the right node", s.singles_by_curve);
  text += share_row("visible singles: wrong terms among all terms", s.single_wrong_terms, s.single_terms);
  text += share_row("other singles: wrong terms among all terms", s.hidden_single_wrong_terms, s.hidden_single_terms);
  text += count_row("other singles (not visible)", s.hidden_singles);
  text += share_row("visible pairs: at least one right", s.pairs_one_right, s.pairs);
  text += share_row("visible pairs: both right", s.pairs_both_right, s.pairs);
  text += share_row("visible pairs: wrong terms among all terms", s.pair_wrong_terms, s.pair_terms);
  text += count_row("other pairs (one effect is not visible)", s.hidden_pairs);
  text += share_row("visible outside: verdict `unexplained`", s.outside_unexplained, s.outsides);
  text += share_row("visible outside: right node", s.outside_node, s.outsides);
  text += share_row("visible outside: right input signal", s.outside_signal, s.outsides);
  text += share_row("visible outside: verdict, node and input signal right", s.outside_all, s.outsides);
  text += share_row("visible outside: an effect of the catalogue is named", s.outside_named, s.outsides);
  text += count_row("other outside (not visible)", s.hidden_outsides);
  text += share_row("eight bodies: first name physically absent", s.eight_first_absent, s.eights);
  text += share_row("eight bodies: any name physically absent", s.eight_name_absent, s.eights);
  text += share_row("eight bodies: any name or curve physically absent", s.eight_term_absent, s.eights);
  text += share_row("eight bodies with a visible effect: effect named", s.eight_effect_named, s.eights_with_effect);
  text += count_row("terms that are a class (\"A or B\"), all motors", s.classes);
  text += count_row("runs that failed (no documented exit code)", s.failures);
  return text + count_row("runs with a documented exit code but no diagnosis", s.refusals);
}

constexpr std::array<const char*, 5> kGroups{"null", "single", "pair", "outside", "eight"};

std::string geometric_mean_K(const std::vector<const Answer*>& answers, const std::string& model, const std::string& sensor) {
  double sum = 0.0;
  int count = 0;
  for (const Answer* answer : answers) {
    if (const auto rmse_K = holdout_rmse_K(*answer, model, sensor); rmse_K && *rmse_K > 0.0) {
      sum += std::log(*rmse_K);
      ++count;
    }
  }
  return count == 0 ? "–" : fmt::format("{:.2f}", std::exp(sum / count));
}

std::string grown_text(const std::vector<const Answer*>& answers, const std::string& other_model) {
  int grown = 0;
  int count = 0;
  for (const Answer* answer : answers) {
    if (const auto grows = error_grows(*answer, other_model)) {
      ++count;
      grown += *grows ? 1 : 0;
    }
  }
  return count == 0 ? "–" : fmt::format("{}/{}", grown, count);
}

std::string coverage_text(const std::vector<const Answer*>& answers) {
  double sum = 0.0;
  int count = 0;
  for (const Answer* answer : answers) {
    for (const double share : coverage_shares(*answer)) {
      sum += share;
      ++count;
    }
  }
  return count == 0 ? "–" : fmt::format("{:.1f} %", 100.0 * sum / count);
}

std::string errors_table(const std::vector<Answer>& answers) {
  std::string text =
      "Geometric mean of the RMS error on the hold-out runs, winding / stator, in K. \"Grown\": larger after the diagnosis by 0.1 K and 5 "
      "%.\n\n"
      "| group | start file | refitted | after | grown against refitted | grown against start file | readings in the 90 % band |\n"
      "|---|---|---|---|---|---|---|\n";
  for (const char* group : kGroups) {
    std::vector<const Answer*> some;
    for (const Answer& answer : answers) {
      if (answer.group() == group) {
        some.push_back(&answer);
      }
    }
    if (some.empty()) {
      continue;
    }
    text += fmt::format("| {} |", group);
    for (const char* model : {"before", "refitted", "after"}) {
      text += fmt::format(" {} / {} |", geometric_mean_K(some, model, "winding_C"), geometric_mean_K(some, model, "stator_C"));
    }
    text += fmt::format(" {} | {} | {} |\n", grown_text(some, "refitted"), grown_text(some, "before"), coverage_text(some));
  }
  return text;
}

std::string grown_list(const std::vector<Answer>& answers) {
  std::string text;
  for (const Answer& answer : answers) {
    for (const char* model : {"refitted", "before"}) {
      if (error_grows(answer, model).value_or(false)) {
        text += fmt::format("| {} | {} |", answer.motor, std::string(model) == "before" ? "start file" : "refitted");
        for (const char* sensor : {"winding_C", "stator_C"}) {
          text += fmt::format(" {:.2f} → {:.2f} |", holdout_rmse_K(answer, model, sensor).value_or(0.0),
                              holdout_rmse_K(answer, "after", sensor).value_or(0.0));
        }
        text += "\n";
      }
    }
  }
  return text.empty() ? "" : "| motor | against | winding / K | stator / K |\n|---|---|---|---|\n" + text;
}

std::string eight_table(const std::vector<Answer>& answers) {
  std::string text;
  for (const Answer& answer : answers) {
    if (answer.group() != "eight" || !answer.exists()) {
      continue;
    }
    std::vector<std::string> named;
    for (const Term& term : terms_of(answer)) {
      const std::string name =
          term.is_curve() ? fmt::format("curve over {}", fmt::join(term.signals, ", ")) : fmt::format("{}", fmt::join(term.names, " or "));
      named.push_back(name + (is_present(term, answer) ? "" : " **absent**"));
    }
    std::vector<std::string> effects;
    for (const TrueEffect& effect : true_effects(answer)) {
      effects.push_back(effect.id);
    }
    text += fmt::format("| {} | {} | {} | {} |\n", answer.motor, fmt::join(effects, ", "), answer.verdict(), fmt::join(named, "; "));
  }
  return text.empty() ? "" : "| motor | its effect | verdict | stated |\n|---|---|---|---|\n" + text;
}

std::string times_text(const std::vector<Answer>& answers) {
  std::vector<double> times_s;
  for (const Answer& answer : answers) {
    times_s.push_back(answer.wall_s);
  }
  if (times_s.empty()) {
    return "No motor was run.\n";
  }
  std::ranges::sort(times_s);
  const std::size_t half = times_s.size() / 2;
  const double median_s = times_s.size() % 2 == 1 ? times_s[half] : 0.5 * (times_s[half - 1] + times_s[half]);
  return fmt::format("{} motors; wall time per motor: median {:.1f} s, maximum {:.1f} s.\n", times_s.size(), median_s, times_s.back());
}

}  // namespace

std::string report_of(const std::vector<Answer>& answers) {
  const Score score = score_of(answers);
  std::string text = "# Score of the independent suite\n\n" + times_text(answers) + "\n" + scores_table(score);
  text += "\n## Error on the hold-out runs\n\n" + errors_table(answers);
  if (const std::string grown = grown_list(answers); !grown.empty()) {
    text += "\nMotors whose error grows:\n\n" + grown;
  }
  if (const std::string eights = eight_table(answers); !eights.empty()) {
    text += "\n## Motors of eight bodies\n\n" + eights;
  }
  if (!score.failed_cases.empty()) {
    text += fmt::format("\n## Failed cases\n\n| motor | problem | truth | answer |\n|---|---|---|---|\n{}\n",
                        fmt::join(score.failed_cases, "\n"));
  }
  return text;
}

}  // namespace heatsoak::suite
