#include "present/evaluation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/lanes.h"
#include "base/quantity.h"
#include "present/closed_loop.h"
#include "present/motor_notes.h"
#include "present/verdict_words.h"
#include "robot/assumed_friction.h"
#include "select/decision.h"

namespace heatsoak::present {
namespace {

/// With fewer samples the ends of a 90 % range are random; it may even exclude the nominal value.
constexpr int kFewestForRange = 20;

std::string peak_text(const select::MotorEvaluation& motor) {
  const select::Spread95& peak = motor.winding_peak_C;
  return motor.samples >= kFewestForRange ? fmt::format("{:.0f} [{:.0f}…{:.0f}]", peak.nominal, peak.p05, peak.p95)
                                          : fmt::format("{:.0f}", peak.nominal);
}

std::string percent_range(const select::Interval95& range) {
  return fmt::format("{:.0f}…{:.0f}", std::floor(100.0 * range.low), std::ceil(100.0 * range.high));
}

Text verdict_cell(const select::MotorEvaluation& motor) {
  return {std::string(verdict_word(motor)), motor.samples_needed ? Tone::undecided : tone_of(motor.verdict)};
}

std::string_view factor_text(const select::MotorEvaluation& motor) {
  switch (motor.limiting_factor) {
    case select::LimitingFactor::none:
      return "–";
    case select::LimitingFactor::winding_temperature:
      return "winding";
    case select::LimitingFactor::stator_temperature:
      return "stator";
    default:
      return select::to_string(motor.limiting_factor);
  }
}

/// A narrower terminal shows the winding temperature over time, scaled to the limit, instead of rank, limit and margin.
constexpr std::size_t kLeastForLimit = 70;

std::vector<Column> columns() {
  constexpr auto kLeft = Alignment::left;
  return {{"", "", 0, Alignment::right, kLeastForLimit},
          {"motor", "", 0, kLeft},
          {"verdict", "", 0, kLeft},
          {"peak", "°C", 0},
          {"limit", "", 0, Alignment::right, kLeastForLimit},
          {"margin", "K", 0, Alignment::right, kLeastForLimit},
          {"winding", "", 1, kLeft},
          {"P over", "%", 2},
          {"reached", "", 3},
          {"limited by", "", 4, kLeft},
          {"A rms", "", 5},
          {"more A", "", 6},
          {"stator", "°C", 7},
          {"limit", "", 8},
          {"data", "", 9, kLeft},
          {"P interval", "%", 10},
          {"p95 interval", "°C", 11}};
}

std::string p95_text(const select::MotorEvaluation& motor) {
  if (!motor.winding_p95_interval_C) {
    return "–";
  }
  const select::Interval95& range_C = *motor.winding_p95_interval_C;
  return std::isfinite(range_C.high) ? fmt::format("{:.0f}…{:.0f}", range_C.low, range_C.high) : fmt::format("≥ {:.0f}", range_C.low);
}

std::vector<Text> row(std::size_t rank, const select::MotorEvaluation& motor, double ambient_C) {
  const Tone tone = tone_of(motor.verdict);
  return {{fmt::format("{}", rank)},
          {motor.motor_id},
          verdict_cell(motor),
          {peak_text(motor)},
          {fmt::format("{:.0f}", motor.winding_limit_C)},
          {fmt::format("{:+.0f}", select::nearest_margin_K(motor))},
          {sparkline(motor, ambient_C), tone},
          {std::isfinite(motor.probability_over_limit) ? fmt::format("{:.0f}", 100.0 * motor.probability_over_limit) : "–"},
          {motor.time_to_limit_s ? duration_text(*motor.time_to_limit_s) : "–"},
          {std::string(factor_text(motor))},
          {fmt::format("{:.2f}", motor.current_rms_A)},
          {motor.margin_A && motor.verdict != select::Verdict::infeasible ? fmt::format("{:+.1f}", *motor.margin_A) : "–"},
          {fmt::format("{:.0f}", motor.stator_peak_C.nominal)},
          {motor.stator_limit_C ? fmt::format("{:.0f}", *motor.stator_limit_C) : "–"},
          {motor.data_quality},
          {motor.probability_interval ? percent_range(*motor.probability_interval) : "–"},
          {p95_text(motor)}};
}

/// Formats as "fails: the winding reaches 162 °C (limit 155 °C, exceeded after 5 min)".
std::string what_happens(const select::MotorEvaluation& motor, bool is_drawn) {
  if (motor.verdict == select::Verdict::infeasible) {
    return fmt::format("cannot drive this duty: {} does not suffice", select::to_string(motor.limiting_factor));
  }
  if (motor.samples_needed) {
    return fmt::format("is undecided: it exceeds a limit with a probability of {} %", percent_range(*motor.probability_interval));
  }
  const bool is_stator = motor.limiting_factor == select::LimitingFactor::stator_temperature;
  const std::string when = motor.verdict == select::Verdict::fail && motor.time_to_limit_s
                               ? fmt::format(", exceeded after {}", duration_text(*motor.time_to_limit_s))
                               : "";
  const std::string reaches = fmt::format("the {} reaches {:.0f} °C (limit {:.0f} °C{})", is_stator ? "stator" : "winding",
                                          is_stator ? motor.stator_peak_C.nominal : motor.winding_peak_C.nominal,
                                          is_stator ? motor.stator_limit_C.value_or(motor.winding_limit_C) : motor.winding_limit_C, when);
  const std::string over = fmt::format("{:.0f} % of the samples exceed a limit", 100.0 * motor.probability_over_limit);
  switch (motor.verdict) {
    case select::Verdict::fail:
      return fmt::format("fails: {}", is_drawn ? over : reaches);
    case select::Verdict::marginal:
      return fmt::format("is marginal: {}",
                         motor.short_probability > std::max(motor.probability_over_limit, select::kMarginalProbability)
                             ? fmt::format("{:.0f} % of the samples cannot deliver the demand", 100.0 * motor.short_probability)
                             : over);
    default:
      return fmt::format("passes{}: {}", motor.samples == 0 ? " with nominal values" : "", reaches);
  }
}

/// Adds the remark that mass and wheels of the robot do not matter if the duty states torque and speed itself.
std::string load_words(const duty::Duty& duty) {
  return duty.shape_data->depends_on_robot()
             ? duty.id
             : fmt::format("{} (a fixed wheel load: mass and wheel size of the robot do not matter)", duty.id);
}

std::vector<Text> headline(const simulate::EvaluationAnswer& answer) {
  const std::vector<select::MotorEvaluation>& results = answer.results;
  const auto sentence = [&](const select::MotorEvaluation& motor, std::string_view prefix) {
    const Tone tone = motor.samples_needed ? Tone::undecided : tone_of(motor.verdict);
    return Text{fmt::format("{}{} {}.", prefix, motor.motor_id, what_happens(motor, answer.draw_count > 0)), tone};
  };
  const auto good = std::ranges::count_if(
      results, [](const select::MotorEvaluation& each) { return each.verdict == select::Verdict::pass && !each.samples_needed; });
  const auto undecided =
      std::ranges::count_if(results, [](const select::MotorEvaluation& each) { return each.samples_needed.has_value(); });
  std::vector<Text> sentences{{fmt::format("{} of {} motor{} pass{} {}{}.", good, results.size(), results.size() == 1 ? "" : "s",
                                           good == 1 || results.size() == 1 ? "es" : "", load_words(answer.duty),
                                           undecided > 0 ? fmt::format("; {} undecided", undecided) : ""),
                               good == 0 ? Tone::bad : Tone::good}};
  sentences.push_back(sentence(results.front(), results.size() > 1 ? "Best: " : ""));
  const auto own = std::ranges::find(results, answer.robot.drive.motor, &select::MotorEvaluation::motor_id);
  if (own != results.end() && own != results.begin()) {
    sentences.push_back(sentence(*own, "The robot's own "));
  }
  return sentences;
}

/// States the sampling error of probability and peak temperature.
std::string sampling_error(std::span<const select::MotorEvaluation> results) {
  double probability_ratio = 0.0;
  double p95_K = 0.0;
  for (const select::MotorEvaluation& each : results) {
    probability_ratio = std::max(probability_ratio, 0.5 * (each.probability_interval->high - each.probability_interval->low));
    p95_K = std::max(p95_K, 0.5 * (each.winding_p95_interval_C->high - each.winding_p95_interval_C->low));
  }
  return fmt::format("Sampling error (95 %): the share over a limit ±{:.0f} percentage points, the upper end of the peak {}.",
                     std::ceil(100.0 * probability_ratio),
                     std::isfinite(p95_K) ? fmt::format("±{:.0f} K", std::ceil(p95_K)) : "unknown: take more samples");
}

std::string undecided_note(const select::MotorEvaluation& motor) {
  const bool is_drawn = motor.games > 0;
  const bool is_short = motor.short_probability > motor.probability_over_limit;
  const auto number = [&](int samples) { return is_drawn ? samples / base::kLanes : samples; };
  const std::string_view unit = is_drawn ? "games" : "samples";
  const std::string so_far =
      fmt::format("{} is undecided after {} {}: the share of samples that {} may lie on either side of a threshold.", motor.motor_id,
                  is_drawn ? motor.games : motor.samples, unit,
                  is_short ? "miss the demand" : fmt::format("exceed a limit ({} %)", percent_range(*motor.probability_interval)));
  const int most = select::most_samples_at_all(is_drawn);
  if (*motor.samples_needed >= most) {
    return fmt::format("{} If the share stays as it is, over {} more {} needed, and --samples takes {} at most: count it as {}.", so_far,
                       number(most), unit, most, select::to_string(motor.verdict));
  }
  return fmt::format("{} If the share stays as it is, about {} more {} needed (--samples {}); until then count it as {}.", so_far,
                     number(*motor.samples_needed) - (is_drawn ? motor.games : motor.samples), unit, *motor.samples_needed,
                     select::to_string(motor.verdict));
}

void add_notes(Document& document, const select::MotorEvaluation& motor, const simulate::EvaluationAnswer& answer) {
  add_lines(document.notes, why_infeasible(motor, answer.robot), Severity::warning);
  if (motor.samples_needed) {
    document.add_note(Severity::warning, undecided_note(motor));
  }
  if (motor.destroyed) {
    document.add_note(Severity::warning, fmt::format("{}: thermal runaway, the calculation ended at 1000 °C", motor.motor_id));
  }
  if (motor.verdict != select::Verdict::infeasible && motor.short_probability > select::kMarginalProbability) {
    document.add_note(Severity::note, fmt::format("{}: {:.0f} % of the samples cannot deliver what is demanded ({})", motor.motor_id,
                                                  100.0 * motor.short_probability, select::to_string(motor.short_limit)));
  }
}

/// Formats "500 samples", or "600 to 9600 samples" if motors needed different numbers.
std::string counted(std::span<const select::MotorEvaluation> results, int select::MotorEvaluation::*count, std::string_view unit) {
  const auto [least, most] = std::ranges::minmax(results, {}, count);
  const std::string number =
      least.*count == most.*count ? fmt::format("{}", most.*count) : fmt::format("{} to {}", least.*count, most.*count);
  return fmt::format("{} {}{}", number, unit, most.*count == 1 ? "" : "s");
}

std::vector<std::string> paragraphs(const simulate::EvaluationAnswer& answer) {
  const std::vector<select::MotorEvaluation>& results = answer.results;
  const bool is_sampled = results.front().samples > 0;
  std::string first = fmt::format("{} on {}: {}, ambient {:.0f} °C, {}.", answer.robot.id, answer.duty.id,
                                  duration_text(answer.demand.duration_s()), answer.duty.ambient_C.value,
                                  is_sampled ? fmt::format("{} of all declared tolerances, seed {}",
                                                           counted(results, &select::MotorEvaluation::samples, "sample"), answer.seed)
                                             : "nominal values only");
  if (answer.draw_count > 0) {
    first += fmt::format(" {} with other inputs and robot parameters; verdict and range cover all of them.",
                         counted(results, &select::MotorEvaluation::games, "game"));
  }
  const auto most = std::ranges::max_element(results, {}, &select::MotorEvaluation::samples);
  if (most->samples != std::ranges::min(results, {}, &select::MotorEvaluation::samples).samples) {
    first += fmt::format(" {} needed most, because its share over a limit is near a threshold.", most->motor_id);
  }
  return {first};
}

std::string shown_value(double value, std::string_view unit) {
  return unit.empty() ? base::significant(value, 3) : fmt::format("{} {}", base::significant(value, 3), unit);
}

/// Formats a change: "jerk limit from 20 m/s³ to 10 m/s³", "motor to nanotec_df45l024048_a2".
std::string change_words(const select::ChangeEffect& change) {
  return change.other_motor.empty() ? fmt::format("{} from {} to {}", select::name_of(change.quantity),
                                                  shown_value(change.before, select::unit_of(change.quantity)),
                                                  shown_value(change.before * change.factor, select::unit_of(change.quantity)))
                                    : fmt::format("motor to {}", change.other_motor);
}

/// Returns whether the motor needs the change to deliver the demand, or whether its effect is larger than its own scatter.
bool counts(const select::ChangeEffect& change) {
  const double error_K = std::isfinite(change.standard_error_K) ? change.standard_error_K : 0.0;
  return change.makes_deliverable || (change.is_deliverable && change.saved_K > std::max(0.5, 2.0 * error_K));
}

/// States the most helpful change; `change` is null if none counts.
std::string best_change_words(const select::ChangeEffect* change, std::span<const select::ChangeEffect> effects,
                              const std::string& motor_id) {
  if (change != nullptr) {
    return change->makes_deliverable
               ? fmt::format("This change lets {} deliver what the duty demands: {}.", change->other_motor.empty() ? motor_id : "the robot",
                             change_words(*change))
               : fmt::format("Largest improvement for {}: {}, {:.0f} K cooler{}.", motor_id, change_words(*change), change->saved_K,
                             change->other_motor.empty() ? "" : " (its mass and size are not compared)");
  }
  const auto largest = std::ranges::max_element(effects, {}, &select::ChangeEffect::saved_K);
  if (largest == effects.end() || largest->is_deliverable || !(largest->saved_K > 0.5)) {
    return fmt::format("No change of the robot by a usual step cools {} by more than its scatter from game to game.", motor_id);
  }
  return fmt::format(
      "No change of the robot by a usual step cools {} and lets it deliver what the duty demands. The largest effect has {}: {:.0f} K "
      "less.",
      motor_id, change_words(*largest), largest->saved_K);
}

/// Adds a table of the changes that cool the winding most, three at most.
void add_changes(Document& document, const simulate::SuggestedChanges& changes) {
  const auto& [motor_id, effects] = changes;
  constexpr std::size_t kMost = 3;
  Table table{.title = fmt::format("Changes that help {} most", motor_id),
              .columns = {{"change", "", 0, Alignment::left},
                          {"from", "", 1, Alignment::right, kLeastForLimit},
                          {"to", "", 1, Alignment::right, kLeastForLimit},
                          {"saves", "K", 0},
                          {"±", "K", 2}},
              .rows = {}};
  const select::ChangeEffect* best = nullptr;
  for (const select::ChangeEffect& each : effects) {
    if (table.rows.size() == kMost || !counts(each)) {
      continue;
    }
    best = best == nullptr ? &each : best;
    const std::string_view unit = select::unit_of(each.quantity);
    const bool is_value = each.other_motor.empty();
    table.rows.push_back({{is_value ? std::string(select::name_of(each.quantity)) : fmt::format("motor {}", each.other_motor)},
                          {is_value ? shown_value(each.before, unit) : ""},
                          {is_value ? shown_value(each.before * each.factor, unit) : ""},
                          {fmt::format("{:.0f}", each.saved_K)},
                          {std::isfinite(each.standard_error_K) ? fmt::format("{:.0f}", std::ceil(2.0 * each.standard_error_K)) : "–"}});
  }
  document.headline.push_back({best_change_words(best, effects, motor_id)});
  if (best == nullptr) {
    return;
  }
  document.tables.push_back(std::move(table));
  document.add_note(
      Severity::background,
      fmt::format("Changes: mean of {} games with nominal values, each driven with and without the change; ± is two standard errors. The "
                  "motor is the one of the data base with the largest margin; its mass and size are not compared.",
                  select::kChangeGames));
}

}  // namespace

Tone tone_of(select::Verdict verdict) {
  return verdict == select::Verdict::pass ? Tone::good : verdict == select::Verdict::marginal ? Tone::undecided : Tone::bad;
}

void add_lines(std::vector<Note>& notes, std::string_view text, Severity severity) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (end > 0) {
      notes.push_back({severity, std::string(text.substr(0, end))});
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

std::string sparkline(const select::MotorEvaluation& motor, double ambient_C) {
  constexpr std::array<std::string_view, 8> kBlocks{"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  constexpr std::size_t kCells = 8;
  const select::TemperatureCurves& curves = motor.curves;
  if (curves.time_s.empty() || motor.winding_limit_C <= ambient_C) {
    return "";
  }
  std::array<double, kCells> highest_C;
  highest_C.fill(ambient_C);
  for (std::size_t i = 0; i < curves.time_s.size(); ++i) {
    const double place = static_cast<double>(kCells) * curves.time_s[i] / std::max(curves.time_s.back(), 1e-9);
    double& cell_C = highest_C.at(std::min(kCells - 1, static_cast<std::size_t>(place)));
    cell_C = std::max(cell_C, curves.winding_C[i]);
  }
  std::string line;
  for (const double each_C : highest_C) {
    const double level = (each_C - ambient_C) / (motor.winding_limit_C - ambient_C);
    line += kBlocks.at(static_cast<std::size_t>(std::clamp(std::floor(level * kBlocks.size()), 0.0, kBlocks.size() - 1.0)));
  }
  return line;
}

std::string_view verdict_word(const select::MotorEvaluation& motor) {
  return motor.samples_needed ? "undecided" : select::to_string(motor.verdict);
}

namespace {

/// Returns the ranking by samples with its notes.
Document ranking_document(const simulate::EvaluationAnswer& answer) {
  const std::vector<select::MotorEvaluation>& results = answer.results;
  Document document{.headline = headline(answer), .paragraphs = paragraphs(answer)};
  Table table{.columns = columns()};
  for (std::size_t i = 0; i < results.size(); ++i) {
    table.rows.push_back(row(i + 1, results[i], answer.duty.ambient_C.value));
  }
  document.tables.push_back(std::move(table));
  for (const select::MotorEvaluation& each : results) {
    add_notes(document, each, answer);
  }
  if (std::ranges::any_of(results, [](const select::MotorEvaluation& each) { return each.data_quality == "estimated"; })) {
    document.add_note(Severity::note,
                      "The temperatures may be wrong by tens of kelvins where the thermal values of a motor are estimates: no manufacturer "
                      "publishes them "
                      "(`heatsoak describe MOTOR` shows each derivation). Calibrate on a bench before you rely on them.");
  }
  add_lines(document.notes, slip_text(answer.demand), Severity::note);
  if (answer.duty.shape_data->depends_on_robot()) {
    document.add_note(
        Severity::background,
        "`heatsoak simulate` gives other temperatures: it adds slip, noisy sensors and the sag of the battery, while here the plan "
        "is followed exactly at the nominal voltage. --closed-loop ranks motors with all that.");
  }
  document.add_note(Severity::background, fmt::format("Load: {}.", answer.duty.origin));
  if (answer.draw_count > 0) {
    document.add_note(Severity::background, "The nominal peak, margin, reached, A rms and more A are of one game, that of the seed.");
  } else if (results.front().samples > 0) {
    document.add_note(Severity::background, sampling_error(results));
  }
  document.add_note(Severity::background,
                    "Columns: peak of the winding, nominal [5th…95th percentile]; margin to the nearer limit; winding over time, from "
                    "ambient to limit; P over, share of samples over a limit; reached, time until the first limit; more A, remaining rms "
                    "current; P interval and p95 interval, the range that other samples would give (P: 95 % for all looks at the games "
                    "together, 97.5 % or more for each). `heatsoak describe verdict` defines the verdicts.");
  return document;
}

}  // namespace

Document evaluation_document(const simulate::EvaluationAnswer& answer) {
  Document document = ranking_document(answer);
  add_motor_notes(document, answer.motors);
  add_lines(document.notes, default_spreads_text(answer.motors), Severity::note);
  if (answer.changes) {
    add_changes(document, *answer.changes);
  }
  add_lines(document.notes, robot::assumed_friction_text(answer.robot), Severity::warning);
  if (answer.closed_loop) {
    add_closed_loop(document, answer.robot, answer.ranks, answer.closed_loop->games, answer.seed);
  }
  return document;
}

}  // namespace heatsoak::present
