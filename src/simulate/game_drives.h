// Drives games in closed loop with several motors, for `evaluate --closed-loop`.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "base/job_progress.h"
#include "simulate/guarded_core.h"
#include "simulate/match_run.h"

namespace heatsoak::simulate {

struct GameDriveOptions {
  int games = 3;
  std::uint64_t seed = 1;  ///< seed of the first game; later games use the following seeds
  double ambient_C = 25.0;
  GuardUse guard = GuardUse::shadow;
  bool is_sensing_ideal = false;
  int threads = 0;  ///< 0: all cores; the result does not depend on it
};

/// First-game value and range of one score over all games.
struct GameSpread {
  double nominal = 0.0;  ///< value of the first game
  double low = 0.0;
  double high = 0.0;
};

/// The motor's file has no rotor_inertia, which is needed for the acceleration of a wheel.
struct NoRotorInertia {};
/// Why a motor cannot be driven: a missing value, or the Failure of the drive core's configuration.
using NotDriven = std::variant<NoRotorInertia, base::Failure>;

struct GameDrives {
  std::string motor_id;
  std::optional<NotDriven> why_none;  ///< empty if the motor was driven
  bool is_guarded = false;
  std::optional<base::Failure> why_no_guard;  ///< reason why the motor has no guard
  std::vector<DriveScore> games;              ///< in the order of the seeds

  /// Returns value and range of one score; needs one or more games.
  [[nodiscard]] GameSpread spread(double DriveScore::*value) const;
  /// Returns the same, or nothing if the games do not have this score.
  [[nodiscard]] std::optional<GameSpread> spread(std::optional<double> DriveScore::*value) const;
};

/// Drives the same games with every motor; the result has the order of `motors`. A motor whose file lacks values for motion is not driven,
/// see GameDrives::why_none. Throws Failure (bad_input) if the robot's file lacks values. The phases are those of
/// drive_phases().
std::vector<GameDrives> drive_games(const robot::Robot& robot, const duty::MatchInputs& inputs, std::span<const motor::Motor> motors,
                                    const GameDriveOptions& options, const base::JobProgress& progress = {});

/// Returns the phases of drive_games() for a number of motors.
std::vector<base::JobPhase> drive_phases(std::size_t motors, const GameDriveOptions& options);

}  // namespace heatsoak::simulate
