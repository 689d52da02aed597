// One match in a closed loop: the game's commands as the ideal robot got them, driven by the real one.
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
  base::Progress progress;  ///< in whole seconds of the match
};

/// What the phases cost the motors.
struct PhaseHeat {
  double time_s = 0.0;
  double copper_J = 0.0;  ///< of all motors
};

struct MatchRun {
  DriveScore score;
  std::array<PhaseHeat, duty::kPhaseNames.size()> phases{};
};

/// What a game asks of a robot that follows the jerk-limited planner exactly, so that every planner, motor and drive core is asked the same
/// at the same time.
struct Game {
  std::vector<duty::ScheduledCommand> script;
  double duration_s = 0.0;
  double aggressiveness = 1.0;
};
Game play_game(const duty::MatchInputs& inputs, const robot::Robot& robot, std::uint64_t seed);

/// Throws Failure (bad_input) if the motor's file has no inertia of the rotor.
void require_rotor_inertia(const motor::Motor& motor);

/// Drives a game. `core` is the robot's (guarded_core.h). `observer` sees every period of the plant.
/// Throws Failure (bad_input) that names what the files of robot or motor lack.
MatchRun run_match(const Game& game, const robot::Robot& robot, const motor::Motor& motor, const robot_core::Config& core,
                   const MatchRunOptions& options, const LoopObserver& observer = {});

}  // namespace heatsoak::simulate
