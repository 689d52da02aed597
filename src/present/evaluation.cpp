#include "present/evaluation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/confidence.h"
#include "base/counted.h"
#include "present/changes.h"
#include "present/closed_loop.h"
#include "present/motor_notes.h"
#include "present/robot_notes.h"
#include "present/undecided.h"
#include "present/verdict_chart.h"
#include "present/verdict_words.h"

namespace heatsoak::present {
namespace {

/// With fewer samples the ends of the range between the percentiles are random; it may even exclude the nominal value.
constexpr int kFewestForRange = 20;

std::string peak_text(const select::MotorEvaluation& motor) {
  const select::Spread95& peak = motor.winding_peak_C;
  return motor.samples >= kFewestForRange && peak.p05 && peak.p95
             ? fmt::format("{:.0f} [{:.0f}…{:.0f}]", peak.nominal, *peak.p05, *peak.p95)
             : fmt::format("{:.0f}", peak.nominal);
}

Text verdict_cell(const select::MotorEvaluation& motor) {
  const ShownVerdict verdict = shown_verdict(motor);
  return {std::string(to_string(verdict)), tone_of(verdict)};
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

/// If `is_drawn`, the nominal run is one of many games. Without samples (`is_sampled`) there is no verdict.
std::vector<Column> columns(bool is_drawn, bool is_sampled) {
  constexpr auto kLeft = Alignment::left;
  constexpr auto kRight = Alignment::right;
  const auto nominal = [is_drawn](std::string_view what) {
    return fmt::format("{}{}", what, is_drawn ? " in the game of the seed" : " with nominal values");
  };
  const std::string level = base::level_text(base::kInterval_share);
  return {
      {"", "", 0, kRight, kLeastForLimit},
      {.name = "motor", .alignment = kLeft, .may_shorten = true},
      is_sampled ? Column{"verdict", "", 0, kLeft, 0, false, "see `heatsoak describe verdict`"}
                 : Column{"nominal", "", 0, kLeft, 0, false, "within or over a temperature limit, or short of the demand; no verdict"},
      {"peak", "°C", 0, kRight, 0, false, nominal("winding") + " [5th…95th percentile of the samples]"},
      {"limit", "°C", 0, kRight, kLeastForLimit, false, "of the winding"},
      {"margin", "K", 0, kRight, kLeastForLimit, false,
       is_drawn ? "to the nearer limit, from the 95th percentile of the samples" : nominal("to the nearer limit")},
      {"winding", "", 1, kLeft, 0, false, nominal("temperature over time, from ambient to limit,")},
      {"samples over", "%", 2, kRight, 0, false, "share of the samples that exceed a temperature limit"},
      {"exceeded after", "", 3, kRight, 0, false, nominal("time until the first limit is exceeded")},
      {"limited by", "", 4, kLeft, 0, false, "limit that decides the verdict"},
      {"current", "A rms", 5, kRight, 0, false, nominal("heating current")},
      {"reserve", "A rms", 6, kRight, 0, false, "additional current at the same speeds until a limit is reached"},
      {"stator", "°C", 7, kRight, 0, false, nominal("peak of the stator")},
      {"stator limit", "°C", 8},
      {"data", "", 9, kLeft, 0, false, "worst origin of the thermal values"},
      {"samples over, interval", "%", 10, kRight, 0, false,
       fmt::format("share over a limit that infinitely many samples would have, with a confidence of {} over all repeated tests", level)},
      {"p95, interval", "°C", 11, kRight, 0, false, "range of the 95th percentile of the peak, if other samples were drawn, " + level}};
}

std::string p95_text(const select::MotorEvaluation& motor) {
  if (!motor.winding_p95_interval_C) {
    return "–";
  }
  const select::Interval95& range_C = *motor.winding_p95_interval_C;
  return std::isfinite(range_C.high) ? fmt::format("{:.0f}…{:.0f}", range_C.low, range_C.high) : fmt::format("≥ {:.0f}", range_C.low);
}

std::vector<Text> row(std::size_t rank, const select::MotorEvaluation& motor, double ambient_C) {
  const Tone tone = tone_of(shown_verdict(motor));
  return {{fmt::format("{}", rank)},
          {motor.motor_id},
          verdict_cell(motor),
          {peak_text(motor)},
          {fmt::format("{:.0f}", motor.winding_limit_C)},
          {fmt::format("{:+.0f}", select::nearest_margin_K(motor))},
          {sparkline(motor, ambient_C), tone},
          {motor.probability_over_limit ? fmt::format("{:.0f}", 100.0 * *motor.probability_over_limit) : "–"},
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

/// Formats as "the winding reaches 162 °C (limit 155 °C, exceeded after 5 min)". On a duty that is drawn the nominal run is one of many
/// games, so the percentile of all of them is stated.
std::string peak_words(const select::MotorEvaluation& motor) {
  const bool is_stator = motor.limiting_factor == select::LimitingFactor::stator_temperature;
  const select::Spread95& peak_C = is_stator ? motor.stator_peak_C : motor.winding_peak_C;
  const double limit_C = is_stator ? motor.stator_limit_C.value_or(motor.winding_limit_C) : motor.winding_limit_C;
  const std::string_view node = is_stator ? "stator" : "winding";
  if (motor.games > 0 && motor.samples >= kFewestForRange && peak_C.p95) {
    return fmt::format("the {} reaches at most {:.0f} °C in {} of the samples (limit {:.0f} °C)", node, *peak_C.p95,
                       base::level_text(base::kHighPercentile_share), limit_C);
  }
  const std::string when = motor.verdict == select::Verdict::fail && motor.time_to_limit_s
                               ? fmt::format(", exceeded after {}", duration_text(*motor.time_to_limit_s))
                               : "";
  return fmt::format("the {} reaches {:.0f} °C (limit {:.0f} °C{})", node, peak_C.nominal, limit_C, when);
}

/// Formats as "fails: the winding reaches 162 °C (limit 155 °C, exceeded after 5 min)".
std::string what_happens(const select::MotorEvaluation& motor) {
  const double over_ratio = motor.probability_over_limit.value_or(0.0);
  const double short_ratio = motor.short_probability.value_or(0.0);
  const std::string over = fmt::format("{:.0f} % of the samples exceed a limit", 100.0 * over_ratio);
  const std::string_view factor = select::to_string(motor.limiting_factor);
  switch (shown_verdict(motor)) {
    case ShownVerdict::infeasible:
      return fmt::format("cannot drive this duty: {} does not suffice", factor);
    case ShownVerdict::undecided:
      return fmt::format("is undecided, {}: {}", needed_words(motor), words_of(*open_share(motor), motor.samples));
    case ShownVerdict::fail:
      return fmt::format("fails: {}", motor.games > 0 ? over : peak_words(motor));
    case ShownVerdict::marginal:
      return fmt::format("is marginal: {}", short_ratio > std::max(over_ratio, select::kMarginalProbability)
                                                ? fmt::format("{:.0f} % of the samples cannot deliver the demand", 100.0 * short_ratio)
                                                : over);
    case ShownVerdict::nominal_within:
      return fmt::format("stays within its limits with nominal values: {}", peak_words(motor));
    case ShownVerdict::nominal_over:
      return fmt::format("exceeds a limit with nominal values: {}", peak_words(motor));
    case ShownVerdict::nominal_short:
      return fmt::format("is short of the demand with nominal values: {} does not suffice", factor);
    case ShownVerdict::pass:
      break;
  }
  return fmt::format("passes: {}", peak_words(motor));
}

/// Formats "1 of 3 motors passes division_a_match; 1 undecided", or without samples "1 of 3 motors stays within the limits on …".
std::string counted_verdicts(const simulate::EvaluationAnswer& answer, const std::string& load) {
  const auto with = [&](ShownVerdict verdict) {
    return std::ranges::count_if(answer.results, [verdict](const auto& each) { return shown_verdict(each) == verdict; });
  };
  const std::size_t all = answer.results.size();
  if (answer.results.front().samples == 0) {
    const auto within = with(ShownVerdict::nominal_within);
    return fmt::format("{} of {} stay{} within the limits on {}", within, base::counted(all, "motor"), within == 1 || all == 1 ? "s" : "",
                       load);
  }
  const auto undecided = with(ShownVerdict::undecided);
  return fmt::format("{} {}{}", passing_text(with(ShownVerdict::pass), all, "motor"), load,
                     undecided > 0 ? fmt::format("; {} undecided", undecided) : "");
}

std::vector<Text> headline(const simulate::EvaluationAnswer& answer) {
  const std::vector<select::MotorEvaluation>& results = answer.results;
  const auto sentence = [](const select::MotorEvaluation& motor, std::string_view prefix) {
    return Text{fmt::format("{}{} {}.", prefix, motor.motor_id, what_happens(motor)), tone_of(shown_verdict(motor))};
  };
  const bool is_sampled = results.front().samples > 0;
  const auto any = [&](ShownVerdict verdict) {
    return std::ranges::any_of(results, [verdict](const auto& each) { return shown_verdict(each) == verdict; });
  };
  const Tone tone = any(ShownVerdict::pass)                                             ? Tone::good
                    : any(ShownVerdict::undecided) || any(ShownVerdict::nominal_within) ? Tone::undecided
                                                                                        : Tone::bad;
  const std::string_view prefix = is_sampled ? "" : "No samples were drawn, so this is no verdict over tolerances: with nominal values ";
  std::vector<Text> sentences{{fmt::format("{}{}.", prefix, counted_verdicts(answer, load_words(answer.duty))), tone}};
  if (const std::string slip = slip_text(answer.demand); !slip.empty()) {
    sentences.push_back({fmt::format("This holds only for a robot that follows the plan exactly, but {}. --closed-loop, or `heatsoak "
                                     "simulate`, shows whether this robot can drive it.",
                                     slip),
                         Tone::undecided});
  }
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
  return fmt::format(
      "Sampling error ({}): ±{:.0f} percentage points for the share of samples over a limit; {} for the 95th percentile of the peak.",
      base::level_text(base::kInterval_share), std::ceil(100.0 * probability_ratio),
      std::isfinite(p95_K) ? fmt::format("±{:.0f} K", std::ceil(p95_K)) : "unknown (more samples needed)");
}

void add_notes(Document& document, const select::MotorEvaluation& motor, const simulate::EvaluationAnswer& answer) {
  add_lines(document.notes, why_infeasible(motor, answer.robot), Severity::warning);
  if (motor.destroyed) {
    document.add_note(Severity::warning, fmt::format("{}: thermal runaway, the calculation ended at 1000 °C", motor.motor_id));
  }
  if (motor.verdict == select::Verdict::infeasible && !answer.closed_loop) {
    document.add_note(Severity::note, fmt::format("{}: the peak of {:.0f} °C is too high, because it assumes the whole demanded current. "
                                                  "`heatsoak simulate` limits the current, and its temperatures are lower.",
                                                  motor.motor_id, motor.winding_peak_C.nominal));
  }
  if (motor.verdict != select::Verdict::infeasible && motor.short_probability > select::kMarginalProbability) {
    document.add_note(Severity::note, fmt::format("{}: {:.0f} % of the samples cannot deliver what is demanded ({})", motor.motor_id,
                                                  100.0 * *motor.short_probability, select::to_string(motor.short_limit)));
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
    first += fmt::format(
        " Verdict, range and margin (to the 95th percentile) cover {} with different inputs and robot parameters. Peak and curve are those "
        "of the game with nominal inputs and this seed.",
        counted(results, &select::MotorEvaluation::games, "game"));
  }
  const auto most = std::ranges::max_element(results, {}, &select::MotorEvaluation::samples);
  if (most->samples != std::ranges::min(results, {}, &select::MotorEvaluation::samples).samples) {
    first += fmt::format(" {} needed most, because its share over a limit is near a threshold.", most->motor_id);
  }
  return {first};
}

}  // namespace

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

namespace {

/// States the rest of a hot motor; returns nothing if it can play on at once.
std::string rest_words(const std::vector<select::RestOfHotMotor>& rests, const std::string& motor_id, double ambient_C) {
  if (rests.front().over_without_current) {
    return fmt::format(
        "A hot {} never cools enough to play: it exceeds its limits even without current in air of {:.0f} °C (nominal values).", motor_id,
        ambient_C);
  }
  std::string text;
  for (std::size_t i = 0; i < rests.size(); ++i) {
    const select::RestOfHotMotor& each = rests[i];
    // If rests are equal, only the one with the longest play is stated.
    const bool is_repeated = i + 1 < rests.size() && each.all_s && rests[i + 1].all_s == each.all_s;
    if (is_repeated || each.all_s == 0.0) {
      continue;
    }
    const std::string play = duration_text(each.play_s);
    text += each.all_s ? fmt::format(" {} for {} of play;", duration_text(*each.all_s), play)
                       : fmt::format(" more than {} for {} of play, at {} of {} moments of the duty;",
                                     duration_text(select::kLongestRest_s), play, each.starts_never, each.starts);
  }
  if (text.empty()) {
    return text;
  }
  text.back() = '.';
  return fmt::format("A {} at its temperature limit must rest before it can play on within its limits (nominal values):{}", motor_id, text);
}

/// Returns the ranking by samples with its notes.
Document ranking_document(const simulate::EvaluationAnswer& answer) {
  const std::vector<select::MotorEvaluation>& results = answer.results;
  Document document{.headline = headline(answer), .paragraphs = paragraphs(answer)};
  Table table{.columns = columns(answer.draw_count > 0, results.front().samples > 0)};
  for (std::size_t i = 0; i < results.size(); ++i) {
    table.rows.push_back(row(i + 1, results[i], answer.duty.ambient_C.value));
  }
  document.tables.push_back(std::move(table));
  if (answer.duty.shape_data->depends_on_robot() && !answer.closed_loop) {
    document.add_note(Severity::scope,
                      "`heatsoak simulate` gives other temperatures, because here the plan is followed exactly at the nominal voltage: "
                      "corrections and slip add heat there; grip, voltage and current limits take heat away. --closed-loop states the "
                      "difference and ranks motors with all that.");
  }
  add_undecided_note(document, results);
  for (const select::MotorEvaluation& each : results) {
    add_notes(document, each, answer);
  }
  document.add_note(Severity::background, fmt::format("The load is {}.", answer.duty.origin));
  for (const auto& [id, rests] : answer.rests) {
    if (id == results.front().motor_id || id == answer.robot.drive.motor) {
      add_lines(document.notes, rest_words(rests, id, answer.duty.ambient_C.value), Severity::background);
    }
  }
  if (answer.draw_count == 0 && results.front().samples > 0) {
    document.add_note(Severity::background, sampling_error(results));
  }
  return document;
}

}  // namespace

report::Chart evaluation_chart(const simulate::EvaluationAnswer& answer) {
  report::Chart chart = verdict_chart(answer.results, answer.robot, answer.duty);
  if (answer.closed_loop) {
    chart.title = "Without a closed loop: " + chart.title;
  }
  return chart;
}

Document evaluation_document(const simulate::EvaluationAnswer& answer) {
  Document document = ranking_document(answer);
  add_motor_notes(document, answer.motors, answer.closed_loop ? Neighbours::known_in_closed_loop : Neighbours::unknown);
  add_lines(document.notes, default_spreads_text(answer.motors), Severity::note);
  if (answer.closed_loop) {
    document.headline.clear();
    const std::string_view how = answer.results.front().samples > 0 ? "with all tolerances" : "with nominal values";
    document.tables.front().title = fmt::format("Without a closed loop, {}", how);
    document.paragraphs.insert(document.paragraphs.begin(), fmt::format("For comparison, without a closed loop and {}: {}.", how,
                                                                        counted_verdicts(answer, answer.duty.id)));
    add_closed_loop(document, answer);
  }
  add_robot_notes(document, answer.robot);
  if (answer.changes) {
    add_changes(document, *answer.changes, answer.duty.shape_data->has_unknowns());
  }
  add_assumed_friction(document, answer.robot);
  // This note is the same for most motors, so it follows those that are about this answer.
  if (std::ranges::any_of(answer.results, [](const select::MotorEvaluation& each) { return each.data_quality == "estimated"; })) {
    document.add_note(Severity::note,
                      "The temperatures may be wrong by tens of kelvins where the thermal values of a motor are estimates: no manufacturer "
                      "publishes them (`heatsoak describe MOTOR` shows each derivation). Calibrate on a bench before you rely on them.");
  }
  document.data = evaluation_json(answer);
  add_notes(document.data, document.notes);
  return document;
}

}  // namespace heatsoak::present
