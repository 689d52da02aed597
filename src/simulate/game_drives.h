// Motors on games in the closed loop: what `evaluate --closed-loop` ranks.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "simulate/guarded_core.h"
#include "simulate/match_run.h"

namespace heatsoak::simulate {

struct GameDriveOptions {
  int games = 3;
  std::uint64_t seed = 1;  ///< of the first game; each further game has the next one
  double ambient_C = 25.0;
  GuardUse guard = GuardUse::shadow;
  bool is_sensing_ideal = false;
  int threads = 0;  ///< 0: all cores; the result does not depend on it
};

/// Of one value over the games.
struct GameSpread {
  double nominal = 0.0;  ///< of the first game
  double low = 0.0;
  double high = 0.0;
};

struct GameDrives {
  std::string motor_id;
  std::string why_none;  ///< why nothing could be driven; empty where it was
  bool is_guarded = false;
  std::string why_no_guard;       ///< as MotorGuard::why_none
  std::vector<DriveScore> games;  ///< by seed

  [[nodiscard]] GameSpread spread(double DriveScore::*value) const;
};

/// In the order of `motors`. Every motor gets the same games. A motor whose file lacks what motion needs is not driven and says so. Throws
/// Failure (bad_input) where the robot's file lacks something. `progress` counts guards and games.
std::vector<GameDrives> drive_games(const robot::Robot& robot, const duty::MatchInputs& inputs, std::span<const motor::Motor> motors,
                                    const GameDriveOptions& options, const base::Progress& progress = {});

}  // namespace heatsoak::simulate
