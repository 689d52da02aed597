#include "present/closed_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/counted.h"
#include "present/evaluation.h"
#include "present/verdict_words.h"
#include "simulate/sensing.h"

namespace heatsoak::present {
namespace {

std::string spread_text(const simulate::GameSpread& spread, double scale, int decimals) {
  if (spread.low == spread.high) {
    return fmt::format("{:.{}f}", scale * spread.nominal, decimals);
  }
  return fmt::format("{:.{}f} [{:.{}f}…{:.{}f}]", scale * spread.nominal, decimals, scale * spread.low, decimals, scale * spread.high,
                     decimals);
}

std::vector<Text> closed_loop_row(std::size_t rank, const simulate::ClosedLoopRank& of) {
  const simulate::GameDrives& drives = of.drives;
  if (drives.games.empty()) {
    std::vector<Text> cells{{fmt::format("{}", rank)}, {drives.motor_id}, {"not driven", Tone::bad}};
    cells.resize(8, {"–"});
    return cells;
  }
  return {{fmt::format("{}", rank)},
          {drives.motor_id},
          {std::string(select::to_string(of.verdict)), tone_of(of.verdict)},
          {spread_text(drives.spread(&simulate::DriveScore::winding_peak_C), 1.0, 0)},
          {spread_text(drives.spread(&simulate::DriveScore::stator_peak_C), 1.0, 0)},
          {drives.is_guarded ? spread_text(drives.spread(&simulate::DriveScore::guard_limited_s), 1.0, 0) : "no guard"},
          {spread_text(drives.spread(&simulate::DriveScore::tracking_rms_m), 1e3, 0)},
          {spread_text(drives.spread(&simulate::DriveScore::distance_m), 1.0, 0)}};
}

/// Returns the sentence about one motor: its peak in the games, or why it was not driven.
Text sentence(const simulate::ClosedLoopRank& rank, std::string_view prefix) {
  const simulate::GameDrives& drives = rank.drives;
  const Tone tone = tone_of(rank.verdict);
  if (drives.games.empty()) {
    return {fmt::format("{}{} was not driven: {}.", prefix, drives.motor_id, why_not_driven(drives)), tone};
  }
  const bool is_stator = rank.stator_limit_C && drives.spread(&simulate::DriveScore::stator_peak_C).high > *rank.stator_limit_C;
  const double peak_C = drives.spread(is_stator ? &simulate::DriveScore::stator_peak_C : &simulate::DriveScore::winding_peak_C).high;
  const std::string reaches = fmt::format("the hottest {} reaches {:.0f} °C (limit {:.0f} °C)", is_stator ? "stator" : "winding", peak_C,
                                          is_stator ? *rank.stator_limit_C : rank.winding_limit_C);
  const auto bad = std::ranges::find_if(drives.games, [](const auto& game) { return simulate::drive_problem(game).has_value(); });
  const bool is_driven = rank.verdict != select::Verdict::infeasible;
  return {fmt::format("{}{} {}: {}.", prefix, drives.motor_id,
                      !is_driven                                  ? "cannot drive this match"
                      : rank.verdict == select::Verdict::fail     ? "fails"
                      : rank.verdict == select::Verdict::marginal ? "is marginal"
                                                                  : "passes",
                      is_driven || bad == drives.games.end() ? reaches : words_of(*simulate::drive_problem(*bad), *bad)),
          tone};
}

void add_closed_loop_headline(Document& document, const simulate::EvaluationAnswer& answer) {
  const std::vector<simulate::ClosedLoopRank>& ranks = answer.ranks;
  const auto passed = std::ranges::count(ranks, select::Verdict::pass, &simulate::ClosedLoopRank::verdict);
  const std::size_t games = ranks.front().drives.games.size();
  document.headline.push_back({fmt::format("Driven in a closed loop, nominal values{}: {} {}; this decides ranking and exit code.",
                                           games > 0 ? fmt::format(", {}", base::counted(games, "game")) : "",
                                           passing_text(passed, ranks.size(), "motor"), answer.duty.id),
                               passed == 0 ? Tone::bad : Tone::good});
  document.headline.push_back(sentence(ranks.front(), ranks.size() > 1 ? "Best: " : ""));
  const auto own = std::ranges::find(ranks, answer.robot.drive.motor, [](const auto& each) { return each.drives.motor_id; });
  if (own != ranks.end() && own != ranks.begin()) {
    document.headline.push_back(sentence(*own, "The robot's own "));
  }
}

/// States for the motor with the largest difference how far the two calculations of the same game are apart, and why.
void add_difference(Document& document, const simulate::EvaluationAnswer& answer) {
  const select::MotorEvaluation* widest = nullptr;
  double difference_K = 0.0;
  for (std::size_t i = 0; i < answer.ranks.size(); ++i) {
    if (answer.ranks[i].drives.games.empty()) {
      continue;
    }
    const double here_K = answer.ranks[i].drives.games.front().winding_peak_C - answer.results[i].winding_peak_C.nominal;
    if (widest == nullptr || std::abs(here_K) > std::abs(difference_K)) {
      widest = &answer.results[i];
      difference_K = here_K;
    }
  }
  if (widest == nullptr) {
    return;
  }
  const bool is_cut = widest->verdict == select::Verdict::infeasible;
  document.add_note(Severity::scope,
                    fmt::format("The first game heats {} to {:.0f} °C in the closed loop and to {:.0f} °C without it, {:.0f} K {}: {}.",
                                widest->motor_id, widest->winding_peak_C.nominal + difference_K, widest->winding_peak_C.nominal,
                                std::abs(difference_K), difference_K < 0.0 ? "less" : "more",
                                is_cut ? "without it the whole demanded current flows, which the driver or the voltage does not allow"
                                       : "corrections and slip add heat; grip, voltage and current limits take heat away"));
}

}  // namespace

std::string why_not_driven(const simulate::GameDrives& drives) {
  if (!drives.why_none) {
    return "";
  }
  const auto* const failure = std::get_if<base::Failure>(&*drives.why_none);
  return failure ? failure->message() : "the motor's file has no rotor_inertia, which is needed for the acceleration of a wheel";
}

std::string words_of(simulate::DriveProblem problem, const simulate::DriveScore& score) {
  switch (problem) {
    case simulate::DriveProblem::battery_empty:
      return fmt::format("the battery is empty after {:.0f} s; the robot stands still for the rest of the match",
                         score.time_s - score.battery_empty_s);
    case simulate::DriveProblem::tips:
      return fmt::format("wheels are off the ground for {:.0f} s: the robot tips", score.lifted_s);
    case simulate::DriveProblem::off_plan:
      break;
  }
  return fmt::format("the robot is {:.1f} m (rms) off its plan, more than its own size: motors, driver or grip are too weak",
                     score.tracking_rms_m);
}

void add_missing_sensors(Document& document, const robot::Robot& robot) {
  if (!simulate::sensing_of(robot).has_motor_current) {
    document.add_note(
        Severity::note,
        fmt::format("{} has no sensors of the motor currents, because its file states no [drive] current_limit: the drive core "
                    "computes the currents from voltage and speed.",
                    robot.id));
  }
}

void add_closed_loop(Document& document, const simulate::EvaluationAnswer& answer) {
  const std::vector<simulate::ClosedLoopRank>& ranks = answer.ranks;
  const int games = answer.closed_loop->games;
  Table table{
      .title = games == 1
                   ? fmt::format("Closed loop: one game driven by the drive core, seed {}", answer.seed)
                   : fmt::format("Closed loop: {} games driven by the drive core, seeds {} to {}; first game [lowest…highest of all]",
                                 games, answer.seed, answer.seed + static_cast<std::uint64_t>(games) - 1),
      .columns = {{"", "", 0},
                  {"motor", "", 0, Alignment::left},
                  {"verdict", "", 0, Alignment::left},
                  {"winding peak", "°C", 0},
                  {"stator peak", "°C", 2},
                  {.name = "guard limits",
                   .unit = "s",
                   .priority = 1,
                   .meaning = "time in which the thermal guard would have limited a motor (here it limits nothing)"},
                  {"error", "mm rms", 3},
                  {"driven", "m", 4}}};
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    table.rows.push_back(closed_loop_row(i + 1, ranks[i]));
    const simulate::GameDrives& drives = ranks[i].drives;
    if (drives.games.empty()) {
      document.add_note(Severity::warning, fmt::format("{} was not driven: {}", drives.motor_id, why_not_driven(drives)));
    }
    const auto bad =
        std::ranges::find_if(drives.games, [](const simulate::DriveScore& game) { return simulate::drive_problem(game).has_value(); });
    if (bad != drives.games.end()) {
      document.add_note(Severity::warning, fmt::format("{}: {}", drives.motor_id, words_of(*simulate::drive_problem(*bad), *bad)));
    }
    if (drives.why_no_guard) {
      document.add_note(Severity::note, fmt::format("{} has no thermal guard: {}", drives.motor_id, drives.why_no_guard->message()));
    }
  }
  add_missing_sensors(document, answer.robot);
  add_closed_loop_headline(document, answer);
  document.tables.insert(document.tables.begin(), std::move(table));
  add_difference(document, answer);
  document.add_note(
      Severity::background,
      "The closed loop has nominal motors, noisy and delayed sensors, lost packets, slip and a sagging battery. The other table has the "
      "torque that an exactly followed plan needs, with tolerances.");
}

}  // namespace heatsoak::present
