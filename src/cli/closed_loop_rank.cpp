#include "cli/closed_loop_rank.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/command.h"
#include "cli/match_simulation.h"
#include "present/evaluation.h"

namespace heatsoak {
namespace {

bool is_over_limit(const ClosedLoopRank& rank, const DriveScore& game) {
  return game.winding_peak_C > rank.winding_limit_C || (rank.stator_limit_C && game.stator_peak_C > *rank.stator_limit_C);
}

Verdict verdict_of(const ClosedLoopRank& rank) {
  const std::vector<DriveScore>& games = rank.drives.games;
  if (games.empty()) {
    return Verdict::infeasible;
  }
  const auto over = std::ranges::count_if(games, [&](const DriveScore& game) { return is_over_limit(rank, game); });
  if (is_over_limit(rank, games.front()) || 2 * over > std::ssize(games)) {
    return Verdict::fail;
  }
  if (std::ranges::any_of(games, [](const DriveScore& game) { return !not_driven(game).empty(); })) {
    return Verdict::infeasible;
  }
  return over > 0 ? Verdict::marginal : Verdict::pass;
}

double margin_K(const ClosedLoopRank& rank) { return rank.winding_limit_C - rank.drives.spread(&DriveScore::winding_peak_C).high; }

std::string text_of(const GameSpread& spread, double scale, int decimals) {
  return fmt::format("{:.{}f} [{:.{}f}…{:.{}f}]", scale * spread.nominal, decimals, scale * spread.low, decimals, scale * spread.high,
                     decimals);
}

std::vector<present::Text> row(std::size_t rank, const ClosedLoopRank& of) {
  const GameDrives& drives = of.drives;
  if (drives.games.empty()) {
    std::vector<present::Text> cells{{fmt::format("{}", rank)}, {drives.motor_id}, {"not driven", present::Tone::bad}};
    cells.resize(8, {"–"});
    return cells;
  }
  return {{fmt::format("{}", rank)},
          {drives.motor_id},
          {std::string(to_string(of.verdict)), present::tone_of(of.verdict)},
          {text_of(drives.spread(&DriveScore::winding_peak_C), 1.0, 0)},
          {text_of(drives.spread(&DriveScore::stator_peak_C), 1.0, 0)},
          {drives.is_guarded ? text_of(drives.spread(&DriveScore::guard_limited_s), 1.0, 0) : "no guard"},
          {text_of(drives.spread(&DriveScore::tracking_rms_m), 1e3, 0)},
          {text_of(drives.spread(&DriveScore::distance_m), 1.0, 0)}};
}

nlohmann::ordered_json json(const GameSpread& spread, int decimals) {
  return {{"nominal", rounded(spread.nominal, decimals)}, {"low", rounded(spread.low, decimals)}, {"high", rounded(spread.high, decimals)}};
}

}  // namespace

std::vector<ClosedLoopRank> rank_closed_loop(std::vector<GameDrives> drives, std::vector<MotorEvaluation>& results) {
  std::vector<std::pair<MotorEvaluation, ClosedLoopRank>> pairs;
  for (MotorEvaluation& result : results) {
    const auto found = std::ranges::find(drives, result.motor_id, &GameDrives::motor_id);
    ClosedLoopRank rank{std::move(*found), result.winding_limit_C, result.stator_limit_C};
    rank.verdict = verdict_of(rank);
    pairs.emplace_back(std::move(result), std::move(rank));
  }
  std::ranges::stable_sort(pairs, [](const auto& a, const auto& b) {
    const ClosedLoopRank& first = a.second;
    const ClosedLoopRank& second = b.second;
    if (first.verdict != second.verdict) {
      return first.verdict < second.verdict;
    }
    const bool is_first_driven = !first.drives.games.empty();
    const bool is_second_driven = !second.drives.games.empty();
    return is_first_driven && is_second_driven ? margin_K(first) > margin_K(second) : is_first_driven && !is_second_driven;
  });
  std::vector<ClosedLoopRank> ranks;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    results[i] = std::move(pairs[i].first);
    ranks.push_back(std::move(pairs[i].second));
  }
  return ranks;
}

void add_closed_loop(present::Document& document, const std::vector<ClosedLoopRank>& ranks, int games, std::uint64_t seed) {
  using present::Alignment;
  using present::Severity;
  present::Table table{
      .title = fmt::format("Closed loop: {} driven by the drive core, seeds {} to {}; first game [lowest…highest of all]",
                           counted(static_cast<std::size_t>(games), "game"), seed, seed + static_cast<std::uint64_t>(games) - 1),
      .columns = {{"", "", 0},
                  {"motor", "", 0, Alignment::left},
                  {"verdict", "", 0, Alignment::left},
                  {"winding peak", "°C", 0},
                  {"stator peak", "°C", 2},
                  {"guard limits", "s", 1},
                  {"error", "mm rms", 3},
                  {"driven", "m", 4}}};
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    table.rows.push_back(row(i + 1, ranks[i]));
    const GameDrives& drives = ranks[i].drives;
    if (drives.games.empty()) {
      document.add_note(Severity::warning, fmt::format("{} was not driven: {}", drives.motor_id, drives.why_none));
    }
    const auto bad = std::ranges::find_if(drives.games, [](const DriveScore& game) { return !not_driven(game).empty(); });
    if (bad != drives.games.end()) {
      document.add_note(Severity::warning, fmt::format("{}: {}", drives.motor_id, not_driven(*bad)));
    }
    if (!drives.why_no_guard.empty()) {
      document.add_note(Severity::note, fmt::format("{} has no thermal guard: {}", drives.motor_id, drives.why_no_guard));
    }
  }
  const auto passed = std::ranges::count(ranks, Verdict::pass, &ClosedLoopRank::verdict);
  document.headline.insert(document.headline.begin(),
                           {fmt::format("Driven in a closed loop, {} of {} pass. The ranking below follows these games.", passed,
                                        counted(ranks.size(), "motor")),
                            passed == 0 ? present::Tone::bad : present::Tone::good});
  document.tables.insert(document.tables.begin(), std::move(table));
  document.add_note(
      Severity::note,
      "The two tables differ: the one without a closed loop uses the torque that an exactly followed plan needs. In the closed loop the "
      "drive core works with noisy, delayed sensors and lost packets, wheels slip, and the battery sags. Corrections add heat; grip, "
      "voltage "
      "and current limits take heat away.");
  document.add_note(Severity::background,
                    "In the closed loop motors are nominal; tolerances are in the other table. guard limits: time in which the "
                    "thermal guard would have limited a motor; here it only counts.");
}

nlohmann::ordered_json closed_loop_json(const ClosedLoopRank& rank, std::uint64_t seed) {
  const GameDrives& drives = rank.drives;
  if (drives.games.empty()) {
    return {{"verdict", to_string(rank.verdict)}, {"games", 0}, {"why_none", drives.why_none}};
  }
  nlohmann::ordered_json answer{{"verdict", to_string(rank.verdict)},
                                {"games", drives.games.size()},
                                {"first_seed", seed},
                                {"winding_peak_C", json(drives.spread(&DriveScore::winding_peak_C), 2)},
                                {"stator_peak_C", json(drives.spread(&DriveScore::stator_peak_C), 2)},
                                {"current_rms_A", json(drives.spread(&DriveScore::current_rms_A), 4)},
                                {"distance_m", json(drives.spread(&DriveScore::distance_m), 2)},
                                {"tracking_rms_m", json(drives.spread(&DriveScore::tracking_rms_m), 6)},
                                {"tracking_most_m", json(drives.spread(&DriveScore::tracking_most_m), 5)},
                                {"slip_m", json(drives.spread(&DriveScore::slip_m), 4)},
                                {"lowest_battery_V", json(drives.spread(&DriveScore::lowest_battery_V), 3)},
                                {"battery_empty_s", json(drives.spread(&DriveScore::battery_empty_s), 3)}};
  answer["guard_limited_s"] = drives.is_guarded ? json(drives.spread(&DriveScore::guard_limited_s), 3) : nlohmann::ordered_json();
  answer["guard_winding_peak_C"] = drives.is_guarded ? json(drives.spread(&DriveScore::guard_winding_peak_C), 2) : nlohmann::ordered_json();
  answer["why_no_guard"] = drives.why_no_guard.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(drives.why_no_guard);
  return answer;
}

}  // namespace heatsoak
