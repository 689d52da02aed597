#include "score.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace heatsoak::suite {
namespace {

std::string text_of(const Term& term) {
  if (term.is_curve()) {
    return fmt::format("curve over {} at {} ({})", fmt::join(term.signals, ", "), term.node, term.names.front());
  }
  return fmt::format("{} at {}", fmt::join(term.names, " or "), term.node);
}

std::string text_of(const std::vector<Term>& terms) {
  std::vector<std::string> texts;
  for (const Term& term : terms) {
    texts.push_back(text_of(term));
  }
  return texts.empty() ? "nothing" : fmt::format("{}", fmt::join(texts, "; "));
}

std::string truth_text(const Answer& answer) {
  std::vector<std::string> texts;
  if (answer.group() == "eight") {
    texts.emplace_back("eight bodies");
  }
  for (const TrueEffect& effect : true_effects(answer)) {
    texts.push_back(fmt::format("{} at {}{}", effect.id, effect.node, effect.is_visible ? "" : " (not visible)"));
  }
  return texts.empty() ? "nothing" : fmt::format("{}", fmt::join(texts, "; "));
}

void add_failed(const Answer& answer, const std::string& problem, Score& score) {
  score.failed_cases.push_back(
      fmt::format("| {} | {} | {} | {}: {} |", answer.motor, problem, truth_text(answer), answer.verdict(), text_of(terms_of(answer))));
}

bool are_visible(const std::vector<TrueEffect>& effects) { return std::ranges::all_of(effects, &TrueEffect::is_visible); }

int wrong_terms(const std::vector<Term>& terms, const std::vector<TrueEffect>& effects) {
  return static_cast<int>(std::ranges::count_if(terms, [&](const Term& term) { return match_of(term, effects) == Match::kNone; }));
}

bool is_stated(const TrueEffect& effect, const std::vector<Term>& terms) {
  return std::ranges::any_of(terms, [&](const Term& term) { return match_of(term, effect) >= Match::kClass; });
}

void score_null(const Answer& answer, Score& score) {
  ++score.nulls;
  score.nulls_unexplained += answer.verdict() == "unexplained" ? 1 : 0;
  if (!terms_of(answer).empty()) {
    ++score.nulls_false_alarm;
    add_failed(answer, "false alarm", score);
  }
}

void score_single(const Answer& answer, Score& score) {
  const std::vector<TrueEffect> effects = true_effects(answer);
  const std::vector<Term> terms = terms_of(answer);
  const int wrong = wrong_terms(terms, effects);
  if (!are_visible(effects)) {
    ++score.hidden_singles;
    score.hidden_single_terms += static_cast<int>(terms.size());
    score.hidden_single_wrong_terms += wrong;
    if (wrong > 0) {
      add_failed(answer, "wrong term, effect not visible", score);
    }
    return;
  }
  ++score.singles;
  score.single_terms += static_cast<int>(terms.size());
  score.single_wrong_terms += wrong;
  score.singles_named += terms.empty() ? 0 : 1;
  Match best = Match::kNone;
  bool is_exact = false;
  for (const Term& term : terms) {
    best = std::max(best, match_of(term, effects.front()));
    is_exact = is_exact || term.names.front() == effects.front().id;
  }
  score.singles_right += best >= Match::kClass ? 1 : 0;
  score.singles_exact += is_exact ? 1 : 0;
  score.singles_by_class += best == Match::kClass ? 1 : 0;
  score.singles_by_curve += best == Match::kCurve ? 1 : 0;
  if (best < Match::kClass) {
    add_failed(answer, terms.empty() ? "not named" : "wrong family", score);
  } else if (wrong > 0) {
    add_failed(answer, "wrong term beside the right one", score);
  }
}

void score_pair(const Answer& answer, Score& score) {
  const std::vector<TrueEffect> effects = true_effects(answer);
  const std::vector<Term> terms = terms_of(answer);
  if (!are_visible(effects)) {
    ++score.hidden_pairs;
    return;
  }
  ++score.pairs;
  score.pair_terms += static_cast<int>(terms.size());
  const int wrong = wrong_terms(terms, effects);
  score.pair_wrong_terms += wrong;
  const auto right = std::ranges::count_if(effects, [&](const TrueEffect& effect) { return is_stated(effect, terms); });
  score.pairs_one_right += right > 0 ? 1 : 0;
  score.pairs_both_right += right == std::ssize(effects) ? 1 : 0;
  if (right < std::ssize(effects)) {
    add_failed(answer, right == 0 ? "neither of the pair" : "one of the pair", score);
  } else if (wrong > 0) {
    add_failed(answer, "wrong term beside the pair", score);
  }
}

/// Node and signals that an answer states for unexplained heat.
std::vector<Term> statements_of(const Answer& answer) {
  std::vector<Term> statements;
  for (const Term& term : terms_of(answer)) {
    if (term.is_curve()) {
      statements.push_back(term);
    }
  }
  if (answer.exists() && answer.answer.contains("unexplained") && answer.answer["unexplained"].is_object()) {
    Term term;
    if (const nlohmann::json& unexplained = answer.answer["unexplained"]; unexplained.contains("node") && unexplained["node"].is_string()) {
      term.node = unexplained["node"].get<std::string>();
    }
    statements.push_back(term);
  }
  return statements;
}

void score_outside(const Answer& answer, Score& score) {
  const TrueEffect effect = true_effects(answer).at(0);
  if (!effect.is_visible) {
    ++score.hidden_outsides;
    return;
  }
  ++score.outsides;
  bool has_node = false;
  bool has_signal = false;
  for (const Term& statement : statements_of(answer)) {
    has_node = has_node || statement.node == effect.node;
    has_signal = has_signal || std::ranges::any_of(statement.signals, [&](const std::string& signal) {
                   return std::ranges::find(effect.signals, signal) != effect.signals.end();
                 });
  }
  const bool is_unexplained = answer.verdict() == "unexplained";
  const bool is_named = std::ranges::any_of(terms_of(answer), [](const Term& term) { return !term.is_curve(); });
  score.outside_unexplained += is_unexplained ? 1 : 0;
  score.outside_node += has_node ? 1 : 0;
  score.outside_signal += has_signal ? 1 : 0;
  score.outside_all += is_unexplained && has_node && has_signal ? 1 : 0;
  score.outside_named += is_named ? 1 : 0;
  if (!(is_unexplained && has_node && has_signal)) {
    add_failed(answer, is_named ? "named although outside" : "outside not recognised", score);
  }
}

void score_eight(const Answer& answer, Score& score) {
  ++score.eights;
  const std::vector<Term> terms = terms_of(answer);
  const auto first_name = std::ranges::find_if(terms, [](const Term& term) { return !term.is_curve(); });
  const bool first_absent = first_name != terms.end() && !is_present(*first_name, answer);
  const bool name_absent = std::ranges::any_of(terms, [&](const Term& term) { return !term.is_curve() && !is_present(term, answer); });
  const bool term_absent = std::ranges::any_of(terms, [&](const Term& term) { return !is_present(term, answer); });
  score.eight_first_absent += first_absent ? 1 : 0;
  score.eight_name_absent += name_absent ? 1 : 0;
  score.eight_term_absent += term_absent ? 1 : 0;
  if (term_absent) {
    add_failed(answer, first_absent ? "first name absent" : name_absent ? "a name absent" : "a curve absent", score);
  }
  if (const std::vector<TrueEffect> effects = true_effects(answer); !effects.empty() && are_visible(effects)) {
    ++score.eights_with_effect;
    score.eight_effect_named += is_stated(effects.front(), terms) ? 1 : 0;
  }
}

}  // namespace

std::pair<double, double> wilson_interval(int hits, int count) {
  if (count == 0) {
    return {0.0, 1.0};
  }
  constexpr double kNormal = 1.959963984540054;  // 97.5th percentile
  const double n = count;
  const double share = hits / n;
  const double shrink = 1.0 + kNormal * kNormal / n;
  const double centre = (share + kNormal * kNormal / (2.0 * n)) / shrink;
  const double half_width = kNormal / shrink * std::sqrt(share * (1.0 - share) / n + kNormal * kNormal / (4.0 * n * n));
  return {std::max(0.0, centre - half_width), std::min(1.0, centre + half_width)};
}

Score score_of(const std::vector<Answer>& answers) {
  Score score;
  for (const Answer& answer : answers) {
    if (!answer.exists()) {
      const bool is_refusal = answer.exit_code >= 0 && answer.exit_code <= 3;
      (is_refusal ? score.refusals : score.failures) += 1;
      add_failed(answer, fmt::format("{}, exit code {}", is_refusal ? "no diagnosis" : "failed run", answer.exit_code), score);
    }
    for (const Term& term : terms_of(answer)) {
      score.classes += term.is_class() ? 1 : 0;
    }
    const std::string group = answer.group();
    if (group == "null") {
      score_null(answer, score);
    } else if (group == "single") {
      score_single(answer, score);
    } else if (group == "pair") {
      score_pair(answer, score);
    } else if (group == "outside") {
      score_outside(answer, score);
    } else if (group == "eight") {
      score_eight(answer, score);
    }
  }
  return score;
}

}  // namespace heatsoak::suite
