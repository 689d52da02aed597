// Ranks motors by the games that the drive core drives in closed loop.
#pragma once

#include <optional>
#include <vector>

#include "select/evaluate.h"
#include "simulate/game_drives.h"

namespace heatsoak::simulate {

struct ClosedLoopRank {
  GameDrives drives;
  double winding_limit_C = 0.0;
  std::optional<double> stator_limit_C;
  /// infeasible: a game could not be driven (drive_problem()), or the file lacks values for motion. fail: the first game exceeds a limit,
  /// or more than half of the games do. marginal: any other game does.
  select::Verdict verdict = select::Verdict::infeasible;
};

/// Sorts `results` and returns the ranks in the same order: by the closed-loop verdict, then by the distance of the hottest winding to its
/// limit. `drives` contains the motors of `results` in any order.
std::vector<ClosedLoopRank> rank_closed_loop(std::vector<GameDrives> drives, std::vector<select::MotorEvaluation>& results);

}  // namespace heatsoak::simulate
