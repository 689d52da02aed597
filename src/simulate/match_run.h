// One match in a closed loop: the game's commands as the ideal robot got them, driven by the real one.
#pragma once

#include "base/parallel.h"
#include "duty/match/match_duty.h"
#include "simulate/drive_score.h"

namespace heatsoak {

struct MatchRunOptions {
  Planner planner = Planner::jerk_limited;
  std::uint64_t seed = 1;
  double ambient_C = 25.0;
  Progress progress;  ///< in whole seconds of the match
};

/// What the phases cost the motors.
struct PhaseHeat {
  double time_s = 0.0;
  double copper_J = 0.0;  ///< of all motors
};

struct MatchRun {
  DriveScore score;
  std::array<PhaseHeat, kPhaseNames.size()> phases{};
};

/// The commands are those that the game gives a robot which follows the jerk-limited planner exactly, so that every
/// planner and controller is asked the same at the same time. `observer` sees every period of the plant.
/// Throws Failure (bad_input) that names what the files of robot or motor lack.
MatchRun run_match(const MatchInputs& inputs, const Robot& robot, const Motor& motor, const MatchRunOptions& options,
                   const LoopObserver& observer = {});

}  // namespace heatsoak
