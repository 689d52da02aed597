#include "simulate/closed_loop_rank.h"

#include <algorithm>
#include <utility>

namespace heatsoak::simulate {
namespace {

bool is_over_limit(const ClosedLoopRank& rank, const DriveScore& game) {
  return game.winding_peak_C > rank.winding_limit_C || (rank.stator_limit_C && game.stator_peak_C > *rank.stator_limit_C);
}

select::Verdict verdict_of(const ClosedLoopRank& rank) {
  const std::vector<DriveScore>& games = rank.drives.games;
  if (games.empty()) {
    return select::Verdict::infeasible;
  }
  const auto over = std::ranges::count_if(games, [&](const DriveScore& game) { return is_over_limit(rank, game); });
  if (is_over_limit(rank, games.front()) || 2 * over > std::ssize(games)) {
    return select::Verdict::fail;
  }
  if (std::ranges::any_of(games, [](const DriveScore& game) { return drive_problem(game).has_value(); })) {
    return select::Verdict::infeasible;
  }
  return over > 0 ? select::Verdict::marginal : select::Verdict::pass;
}

double margin_K(const ClosedLoopRank& rank) { return rank.winding_limit_C - rank.drives.spread(&DriveScore::winding_peak_C).high; }

}  // namespace

std::vector<ClosedLoopRank> rank_closed_loop(std::vector<GameDrives> drives, std::vector<select::MotorEvaluation>& results) {
  std::vector<std::pair<select::MotorEvaluation, ClosedLoopRank>> pairs;
  for (select::MotorEvaluation& result : results) {
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

}  // namespace heatsoak::simulate
