#include "simulate/match_run.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/diagnostic.h"

namespace heatsoak::simulate {

Game game_of(const duty::MatchInputs& inputs, const duty::MatchLoad& load) {
  return {load.script, load.duration_s, inputs.nominal().aggressiveness};
}

Game play_game(const duty::MatchInputs& inputs, const robot::Robot& robot, std::uint64_t seed) {
  return game_of(inputs, duty::play_nominal(inputs, robot, seed));
}

MatchRun run_match(const Game& game, const robot::Robot& robot, const motor::Motor& motor, const robot_core::Config& core,
                   const MatchRunOptions& options, const LoopObserver& observer) {
  SimulatedRobot simulated(robot, motor, options.ambient_C, options.start_C);
  CoreDrive drive(core, simulated, options.drive);
  const std::unique_ptr<duty::Follower> plan = duty::ideal_tracking(robot, game.aggressiveness, options.planner);
  MatchRun run;
  DriveScorer scorer;
  const auto all_s = static_cast<std::size_t>(game.duration_s);
  std::size_t whole_s = 0;
  drive_script(simulated, drive, *plan, game.script, game.duration_s, [&](const LoopMoment& moment) {
    scorer.take(moment);
    PhaseHeat& phase = run.phases.at(static_cast<std::size_t>(moment.command->phase));
    phase.time_s += SimulatedRobot::kPeriod_s;
    phase.copper_J += std::accumulate(moment.out->copper_W.begin(), moment.out->copper_W.end(), 0.0) * SimulatedRobot::kPeriod_s;
    if (observer) {
      observer(moment);
    }
    if (options.progress && moment.time_s >= static_cast<double>(whole_s + 1)) {
      options.progress(std::min(++whole_s, all_s), all_s);
    }
  });
  run.score = scorer.finish();
  return run;
}

void require_rotor_inertia(const motor::Motor& motor) {
  if (!motor.nominal.rotor_inertia_kg_m2) {
    throw base::bad_input({motor.file.string()}, "figures.rotor_inertia",
                          "is missing in the motor file: it is needed for the acceleration of a wheel");
  }
}

}  // namespace heatsoak::simulate
