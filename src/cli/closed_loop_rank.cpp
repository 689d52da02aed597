#include "cli/closed_loop_rank.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/command.h"
#include "cli/match_simulation.h"
#include "cli/verdict_words.h"

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

std::string closed_loop_text(const std::vector<ClosedLoopRank>& ranks, int games, std::uint64_t seed) {
  std::string text = fmt::format(
      "\nclosed loop: {} driven by the drive core, seeds {} to {}; first game [lowest…highest of all]\n"
      "{:3}  {:32} {:10}  {:>18}  {:>18}  {:>18}  {:>18}  {:>18}\n",
      counted(static_cast<std::size_t>(games), "game"), seed, seed + static_cast<std::uint64_t>(games) - 1, "", "motor", "verdict",
      "winding peak °C", "stator peak °C", "driven / m", "error / mm rms", "guard limits / s");
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    const GameDrives& drives = ranks[i].drives;
    if (drives.games.empty()) {
      text += fmt::format("{:3}  {:32} {:10}  {}\n", i + 1, drives.motor_id, "not driven", drives.why_none);
      continue;
    }
    const std::string guard = drives.is_guarded ? text_of(drives.spread(&DriveScore::guard_limited_s), 1.0, 0) : "no guard";
    text += fmt::format("{:3}  {:32} {:10}  {:>18}  {:>18}  {:>18}  {:>18}  {:>18}\n", i + 1, drives.motor_id, to_string(ranks[i].verdict),
                        text_of(drives.spread(&DriveScore::winding_peak_C), 1.0, 0),
                        text_of(drives.spread(&DriveScore::stator_peak_C), 1.0, 0), text_of(drives.spread(&DriveScore::distance_m), 1.0, 0),
                        text_of(drives.spread(&DriveScore::tracking_rms_m), 1e3, 0), guard);
  }
  for (const ClosedLoopRank& rank : ranks) {
    const auto bad = std::ranges::find_if(rank.drives.games, [](const DriveScore& game) { return !not_driven(game).empty(); });
    if (bad != rank.drives.games.end()) {
      text += fmt::format("{}: {}\n", rank.drives.motor_id, not_driven(*bad));
    }
    if (!rank.drives.why_no_guard.empty()) {
      text += fmt::format("{}: no thermal guard: {}\n", rank.drives.motor_id, rank.drives.why_no_guard);
    }
  }
  return text +
         "The list above takes the torque that an exactly followed plan needs. Here the drive core controls the wheels from noisy, "
         "delayed\n"
         "sensors and lost radio packets, wheels creep and slide, the battery sags and empties, windings warm and resist more. "
         "Corrections\n"
         "make more heat; what grip, voltage and current limits take away makes less. Motors are nominal: tolerances stand in the list "
         "above.\n"
         "guard limits: time in which the thermal guard would have limited a motor; here it only counts.\n";
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
