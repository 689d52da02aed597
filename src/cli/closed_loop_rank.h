// `evaluate --closed-loop`: results of games driven by the drive core, shown beside the open-loop evaluation.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "present/document.h"
#include "select/evaluate.h"
#include "simulate/game_drives.h"

namespace heatsoak {

struct ClosedLoopRank {
  GameDrives drives;
  double winding_limit_C = 0.0;
  std::optional<double> stator_limit_C;
  /// infeasible: a game could not be driven (not_driven()), or the file lacks values for motion. fail: the first game exceeds a limit, or
  /// more than half of the games do. marginal: any other game does.
  Verdict verdict = Verdict::infeasible;
};

/// Sorts `results` and returns the ranks in the same order: by the closed-loop verdict, then by the distance of the hottest winding to its
/// limit. `drives` contains the motors of `results` in any order.
std::vector<ClosedLoopRank> rank_closed_loop(std::vector<GameDrives> drives, std::vector<MotorEvaluation>& results);

/// Puts the verdicts of the driven games first and adds their table and notes to those of the evaluation.
void add_closed_loop(present::Document& document, const std::vector<ClosedLoopRank>& ranks, int games, std::uint64_t seed);
nlohmann::ordered_json closed_loop_json(const ClosedLoopRank& rank, std::uint64_t seed);

}  // namespace heatsoak
