// Computes the demand of a robot's wheels from a recorded game.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/job_progress.h"
#include "duty/demand.h"
#include "robot/inverse_dynamics.h"

namespace heatsoak::duty {

struct GameDemand {
  std::string player;                  ///< name, for example "yellow 3"
  std::vector<WheelDemand> wheels;     ///< empty if no robot was tracked long enough
  std::vector<std::string> sentences;  ///< report: quality of the log, bandwidth of the smoothing, share of time over the grip
};

/// Called with the duration and the wheel demands of every moment in order.
using GameObserver = std::function<void(double duration_s, const robot::WheelDemands& wheels)>;

/// Computes the demand of one robot; if `player` is empty, of the robot with the largest ∫a². The motion is smoothed and evaluated at 1 kHz
/// with the inverse dynamics. While the robot is not seen, the wheels stand. Throws Failure (bad_input) for an unreadable log or an unknown
/// player.
GameDemand demand_of_game(const std::filesystem::path& log, const std::string& player, const robot::Robot& robot, double bin_s = kBin_s,
                          const GameObserver& observer = {}, const base::JobProgress& progress = {});

}  // namespace heatsoak::duty
