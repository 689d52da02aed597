#include "simulate/match_simulation.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/diagnostic.h"
#include "robot/assumed_friction.h"

namespace heatsoak::simulate {
namespace {

constexpr double kMostCsvRows = 500'000.0;  ///< about 250 MB of text
constexpr double kLongestMatch_s = 1e4;
const std::string kGuarding = "making the thermal guard";
const std::string kGame = "playing the game";
const std::string kDriving = "driving";

void check_table(const MatchJob& job) {
  if (job.with_table && job.planners.size() > 1) {
    throw base::Failure(base::ExitCode::bad_input, "--out holds one run; expected --planner bang_bang or jerk_limited with it");
  }
  if (job.with_table && kLongestMatch_s / job.every_s > kMostCsvRows) {
    throw base::Failure(base::ExitCode::bad_input,
                        fmt::format("--every {} s makes too many rows of a match; expected 0.02 s or more", job.every_s));
  }
}

MatchRunOptions run_options(const MatchJob& job, const robot::Robot& robot, duty::Planner planner, base::Progress progress) {
  MatchRunOptions options;
  options.planner = planner;
  options.ambient_C = job.duty.ambient_C.value;
  options.drive = job.is_sensing_ideal ? ideal_drive() : real_drive(robot, job.seed);
  options.progress = std::move(progress);
  return options;
}

DrivenMatch drive_once(const MatchJob& job, const robot::Robot& robot, const Game& game, const robot_core::Config& core,
                       const MatchRunOptions& options) {
  DrivenMatch driven{.planner = options.planner, .run = {}, .csv = {}, .rows = {}};
  const double ambient_C = job.duty.ambient_C.value;
  const auto wheels = static_cast<int>(robot.wheels.axis_rad.size());
  const MatchAdditions added = additions_of(job.motor);
  if (job.with_table) {
    driven.csv = csv_header(wheels, added);
  }
  MatchRows csv(job.every_s, ambient_C, added, [&](const MatchRow& row) { append_csv(driven.csv, row, wheels, ambient_C, added); });
  MatchRows kept(kMatchRow_s, ambient_C, {}, [&](const MatchRow& row) { driven.rows.push_back(row); });
  driven.run = run_match(game, robot, job.motor, core, options, [&](const LoopMoment& moment) {
    if (job.with_table) {
      csv.take(moment);
    }
    if (job.with_rows) {
      kept.take(moment);
    }
  });
  csv.finish();
  kept.finish();
  return driven;
}

select::Verdict verdict_of(const DriveScore& score, const motor::MotorValues& limits) {
  if (score.winding_peak_C > limits.winding_limit_C || (limits.stator_limit_C && score.stator_peak_C > *limits.stator_limit_C)) {
    return select::Verdict::fail;
  }
  return drive_problem(score) ? select::Verdict::infeasible : select::Verdict::pass;
}

/// Drives the game once more with the motor at the upper end of its forecast band. The firmware has the nominal motor.
void add_upper(const MatchJob& job, const motor::Motor& upper, const robot::Robot& robot, const Game& game, const robot_core::Config& core,
               const MatchRunOptions& options, DrivenMatch& driven) {
  driven.upper = run_match(game, robot, upper, core, options).score;
  driven.verdict = select::with_upper(driven.verdict, verdict_of(*driven.upper, job.motor.nominal));
}

}  // namespace

const DrivenMatch& MatchSimulation::deciding() const {
  for (const select::Verdict verdict : {select::Verdict::fail, select::Verdict::infeasible, select::Verdict::marginal}) {
    const auto found = std::ranges::find(runs, verdict, &DrivenMatch::verdict);
    if (found != runs.end()) {
      return *found;
    }
  }
  return runs.front();
}

select::Verdict MatchSimulation::verdict() const { return deciding().verdict; }

MatchSimulation simulate_match(const MatchJob& job, const base::JobProgress& progress) {
  firmware::require_drive_values(robot::with_assumed_friction(job.robot), {&job.motor, 1});
  check_table(job);
  const duty::MatchInputs& inputs = dynamic_cast<const duty::MatchDuty&>(*job.duty.shape_data).inputs();
  MatchSimulation answer{.robot = robot::with_assumed_friction(job.robot),
                         .motor = job.motor,
                         .duty = job.duty,
                         .role = inputs.role,
                         .seed = job.seed,
                         .guard_use = job.guard,
                         .guard = {},
                         .is_sensing_ideal = job.is_sensing_ideal,
                         .runs = {}};
  std::vector<base::JobPhase> phases{{kGame, kPlayedGame_s}};
  const std::optional<motor::Motor> upper = motor::at_upper_band(job.motor);
  for (std::size_t i = 0; i < job.planners.size() * (upper ? 2 : 1); ++i) {
    phases.push_back({kDriving, kDrive_s});
  }
  if (job.guard != GuardUse::off) {
    phases.insert(phases.begin(), {kGuarding, kGuard_s});
  }
  progress.expect(std::move(phases));
  if (job.guard != GuardUse::off) {
    answer.guard = make_guard(job.motor, answer.robot, job.duty.ambient_C.value, 0, progress.begin(kGuarding));
  }
  progress.begin(kGame);
  const Game game = play_game(inputs, answer.robot, job.seed);
  for (const duty::Planner planner : job.planners) {
    const GuardedCore core(answer.robot, job.motor, job.guard, answer.guard);
    answer.runs.push_back(
        drive_once(job, answer.robot, game, core.config(), run_options(job, answer.robot, planner, progress.begin(kDriving))));
    answer.runs.back().verdict = verdict_of(answer.runs.back().run.score, job.motor.nominal);
    if (upper) {
      const GuardedCore again(answer.robot, job.motor, job.guard, answer.guard);
      add_upper(job, *upper, answer.robot, game, again.config(), run_options(job, answer.robot, planner, progress.begin(kDriving)),
                answer.runs.back());
    }
  }
  return answer;
}

}  // namespace heatsoak::simulate
