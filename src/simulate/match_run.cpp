#include "simulate/match_run.h"

#include <algorithm>
#include <numeric>

namespace heatsoak {

MatchRun run_match(const MatchInputs& inputs, const Robot& robot, const Motor& motor, const MatchRunOptions& options,
                   const LoopObserver& observer) {
  const MatchValues values = inputs.nominal();
  const MatchLoad game = play_match(inputs, values, robot, options.seed, Planner::jerk_limited);
  const double period_s = control_period_s(robot);
  SimulatedRobot simulated(robot, motor, options.ambient_C);
  const std::unique_ptr<DriveController> controller = tracking_controller(robot, motor.nominal, period_s);
  const std::unique_ptr<Follower> plan = ideal_tracking(robot, values.aggressiveness, options.planner);
  MatchRun run;
  DriveScorer scorer;
  const auto all_s = static_cast<std::size_t>(game.duration_s);
  std::size_t whole_s = 0;
  drive_script(simulated, *controller, *plan, game.script, game.duration_s, period_s, [&](const LoopMoment& moment) {
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

}  // namespace heatsoak
