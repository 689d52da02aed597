// Computes the demand of a robot's wheels from a recorded game.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostic.h"
#include "base/job_progress.h"
#include "duty/demand.h"
#include "duty/import_report.h"
#include "duty/motion.h"
#include "robot/inverse_dynamics.h"

namespace heatsoak::duty {

/// Smallest detection rate that resolves the accelerations of a robot of this league.
inline constexpr double kFewestSights_Hz = 10.0;
/// Longer gaps count as a jump of the recording's clock, because no break of a game is as long.
inline constexpr double kLongestAbsence_s = 3600.0;

struct GameDemand {
  std::string player = {};               ///< name, for example "yellow 3"; empty if the log has no robot
  std::vector<WheelDemand> wheels = {};  ///< empty if no robot was tracked long enough; `slip_share` is the time over the grip
  ImportReport log;
  std::optional<SmoothingReport> smoothing = {};  ///< empty if no robot was tracked long enough
  std::optional<double> low_sight_rate_Hz = {};   ///< detection rate, if it is below kFewestSights_Hz
  double unseen_s = 0.0;                          ///< time without detection, counted as standstill
  int clock_jumps = 0;                            ///< gaps longer than kLongestAbsence_s, which are omitted
};

/// The log does not answer the question. `game()` has what was found, at least the report on the log.
class GameNotUsable : public base::Failure {
 public:
  GameNotUsable(base::ExitCode code, std::string message, GameDemand game)
      : base::Failure(code, std::move(message)), game_(std::move(game)) {}
  [[nodiscard]] const GameDemand& game() const { return game_; }

 private:
  GameDemand game_;
};

/// Called with the duration and the wheel demands of every moment in order.
using GameObserver = std::function<void(double duration_s, const robot::WheelDemands& wheels)>;

/// Computes the demand of one robot; if `player` is empty, of the robot with the largest ∫a². The motion is smoothed and evaluated at 1 kHz
/// with the inverse dynamics. While the robot is not seen, the wheels stand. Throws Failure (bad_input) for an unreadable log and
/// GameNotUsable for an unknown player.
GameDemand demand_of_game(const std::filesystem::path& log, const std::string& player, const robot::Robot& robot, double bin_s = kBin_s,
                          const GameObserver& observer = {}, const base::JobProgress& progress = {});

}  // namespace heatsoak::duty
