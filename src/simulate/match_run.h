// Runs one match in closed loop: the commands of an ideally tracked game, driven by the simulated robot.
#pragma once

#include <optional>

#include "base/parallel.h"
#include "duty/match/match_duty.h"
#include "simulate/drive_score.h"

namespace heatsoak::simulate {

struct MatchRunOptions {
  duty::Planner planner = duty::Planner::jerk_limited;
  double ambient_C = 25.0;
  std::optional<double> start_C = {};  ///< initial temperature of the motors; the ambient if empty
  DriveOptions drive;
  base::Progress progress;  ///< progress in whole seconds of the match
};

/// Duration of a phase of the match and copper heat in it.
struct PhaseHeat {
  double time_s = 0.0;
  double copper_J = 0.0;  ///< sum of all motors
};

struct MatchRun {
  DriveScore score;
  std::array<PhaseHeat, duty::kPhaseNames.size()> phases{};
};

/// Commands of a game for a robot that follows the jerk-limited planner exactly. Every planner, motor and drive core then gets the same
/// commands at the same times.
struct Game {
  std::vector<duty::ScheduledCommand> script;
  double duration_s = 0.0;
  double aggressiveness = 1.0;
};
/// Plays the game with nominal inputs.
Game play_game(const duty::MatchInputs& inputs, const robot::Robot& robot, std::uint64_t seed);
/// Returns the game of a load from duty::play_nominal() with the same inputs.
Game game_of(const duty::MatchInputs& inputs, const duty::MatchLoad& load);

/// Throws Failure (bad_input) if the motor file has no rotor inertia.
void require_rotor_inertia(const motor::Motor& motor);

/// Drives a game. `core` is the core's configuration for this robot and motor (guarded_core.h). `observer` is called after every plant
/// period. Throws Failure (bad_input) that names the values missing from the files of robot or motor.
MatchRun run_match(const Game& game, const robot::Robot& robot, const motor::Motor& motor, const robot_core::Config& core,
                   const MatchRunOptions& options, const LoopObserver& observer = {});

}  // namespace heatsoak::simulate
