#include "simulate/evaluation.h"

#include <fmt/format.h>

#include <algorithm>
#include <ranges>

#include "base/diagnostic.h"
#include "base/parallel.h"
#include "duty/match/match_duty.h"
#include "robot/assumed_friction.h"
#include "select/decision.h"

namespace heatsoak::simulate {
namespace {

void check_job(const EvaluationJob& job, bool is_match) {
  if (job.closed_loop && !is_match) {
    throw base::Failure(base::ExitCode::bad_input,
                        fmt::format("--closed-loop can drive only a match; {} is {}. Expected a duty of the shape match, or no "
                                    "--closed-loop",
                                    job.duty.id, job.duty.shape));
  }
  if (job.closed_loop) {
    // If several motors are compared, those without a rotor inertia are listed as not driven.
    const bool is_any_complete =
        std::ranges::any_of(job.motors, [](const motor::Motor& each) { return each.nominal.rotor_inertia_kg_m2.has_value(); });
    firmware::require_drive_values(robot::with_assumed_friction(job.robot),
                                   job.has_chosen_motors || !is_any_complete ? std::span(job.motors) : std::span<const motor::Motor>());
  }
  if (const int most = select::most_samples_at_all(job.duty.shape_data->has_unknowns()); job.samples.value_or(0) > most) {
    throw base::Failure(
        base::ExitCode::bad_input,
        fmt::format("--samples {}: a game is played for every eight samples on {}; expected at most {}", *job.samples, job.duty.id, most));
  }
}

const std::string kFirstGame = "playing the nominal game";
const std::string kChanging = "trying changes";

GameDriveOptions drive_options(const EvaluationJob& job) {
  const ClosedLoopJob loop = job.closed_loop.value_or(ClosedLoopJob{});
  return {loop.games, job.seed, job.duty.ambient_C.value, loop.guard, false, job.threads};
}

/// Returns the element of the motor that the changes are for, in a range of results or prospects: the robot's own, else the best.
template <class Range, class Id>
const auto& subject_of(const Range& motors, const robot::Robot& robot, Id id) {
  const auto own = std::ranges::find(motors, robot.drive.motor, id);
  return own == motors.end() ? motors.front() : *own;
}

std::optional<SuggestedChanges> changes_for(const EvaluationJob& job, const EvaluationAnswer& answer, const base::JobProgress& progress) {
  if (!job.with_changes) {
    return std::nullopt;
  }
  const select::MotorEvaluation& subject = subject_of(answer.results, answer.robot, &select::MotorEvaluation::motor_id);
  const bool passes = subject.verdict == select::Verdict::pass;
  if (passes && !job.with_changes_if_passing) {
    return std::nullopt;
  }
  const motor::Motor& motor = *std::ranges::find(job.motors, subject.motor_id, &motor::Motor::id);
  const bool none_passes =
      std::ranges::none_of(answer.results, [](const select::MotorEvaluation& each) { return each.verdict == select::Verdict::pass; });
  const bool offers_motor = job.database && (!job.has_chosen_motors || none_passes);
  // Otherwise only the compared motors may replace it.
  const std::vector<motor::Motor> others = passes ? std::vector<motor::Motor>() : offers_motor ? job.database() : job.motors;
  return SuggestedChanges{
      subject.motor_id, passes,
      select::effects_of_changes(answer.robot, job.duty, motor, others, job.seed, job.threads, progress.begin(kChanging))};
}

/// Returns the rests of every motor that can drive the duty, on the wheel that its result is for.
std::map<std::string, std::vector<select::RestOfHotMotor>> rests_of(const EvaluationAnswer& answer,
                                                                    std::span<const duty::WheelDemand> wheels, int threads) {
  std::vector<std::vector<select::RestOfHotMotor>> rests(answer.results.size());
  base::in_parallel(rests.size(), threads, [&](std::size_t i) {
    const select::MotorEvaluation& result = answer.results[i];
    if (result.verdict != select::Verdict::infeasible) {
      const duty::WheelDemand& wheel = *std::ranges::find(wheels, result.wheel, &duty::WheelDemand::wheel);
      const motor::Motor& motor = *std::ranges::find(answer.motors, result.motor_id, &motor::Motor::id);
      rests[i] = select::rests_of_hot_motor(answer.robot, answer.duty, wheel, motor);
    }
  });
  std::map<std::string, std::vector<select::RestOfHotMotor>> by_id;
  for (std::size_t i = 0; i < rests.size(); ++i) {
    if (!rests[i].empty()) {
      by_id.emplace(answer.results[i].motor_id, std::move(rests[i]));
    }
  }
  return by_id;
}

}  // namespace

select::Verdict EvaluationAnswer::worst_verdict() const {
  return ranks.empty() ? std::ranges::max(results | std::views::transform(select::worst_allowed_verdict))
                       : std::ranges::max_element(ranks, {}, &ClosedLoopRank::verdict)->verdict;
}

EvaluationAnswer run_evaluation(const EvaluationJob& job, const base::JobProgress& progress) {
  const auto match = std::dynamic_pointer_cast<const duty::MatchDuty>(job.duty.shape_data);
  check_job(job, match != nullptr);
  EvaluationAnswer answer{.robot = match ? robot::with_assumed_friction(job.robot) : job.robot,
                          .duty = job.duty,
                          .motors = job.motors,
                          .conditions = job.conditions,
                          .seed = job.seed,
                          .samples = job.samples.value_or(select::first_samples(job.duty.shape_data->has_unknowns())),
                          .demand = {},
                          .results = {},
                          .rests = {},
                          .closed_loop = job.closed_loop,
                          .ranks = {},
                          .changes = {}};
  select::EvaluateOptions options;
  options.samples = answer.samples;
  options.seed = job.seed;
  options.threads = job.threads;
  options.with_curves = true;
  options.with_bands = job.with_bands;
  const int most = job.samples.value_or(select::most_samples(job.duty));
  const GameDriveOptions drive = drive_options(job);
  progress.expect({{kFirstGame, kPlayedGame_s}}, true);
  progress.begin(kFirstGame);
  const std::vector<duty::WheelDemand> wheels = job.duty.demand(answer.robot, job.seed);
  std::vector<duty::WheelDemand> draws;
  const auto later = [&](std::span<const select::Prospect> prospects) {
    std::vector<base::JobPhase> phases = job.closed_loop ? drive_phases(job.motors.size(), drive) : std::vector<base::JobPhase>();
    if (job.with_changes) {
      const bool may_fail = !prospects.empty() && subject_of(prospects, answer.robot, &select::Prospect::motor_id).pass_probability() < 0.5;
      constexpr std::size_t kUsualOthers = 30;
      if (may_fail || job.with_changes_if_passing) {
        phases.push_back({kChanging, select::changes_work_s(answer.robot, job.duty, may_fail ? kUsualOthers : 0)});
      }
    }
    return phases;
  };
  answer.results = select::evaluate_until_decided(answer.robot, job.duty, wheels, job.motors, options, most, draws, {progress, later});
  answer.demand = wheels.front();
  answer.draw_count = draws.size();
  if (job.closed_loop) {
    answer.ranks = rank_closed_loop(drive_games(answer.robot, match->inputs(), job.motors, drive, progress), answer.results);
  }
  answer.rests = rests_of(answer, wheels, job.threads);
  answer.changes = changes_for(job, answer, progress);
  return answer;
}

}  // namespace heatsoak::simulate
