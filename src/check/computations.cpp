#include "check/computations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "duty/match/match_duty.h"
#include "motor/default_spread.h"
#include "simulate/core_drive.h"
#include "simulate/guarded_core.h"

namespace heatsoak::check {
namespace {

std::string key_of(const motor::Motor& motor) {
  std::string key = motor.file.string();
  for (const auto& [name, value] : motor.assumed) {
    key += fmt::format("|{}={}", name, value);
  }
  return key;
}

/// Returns the duty as a match; null if it has another shape.
std::shared_ptr<const duty::MatchDuty> match_of(const Check& check) {
  return std::dynamic_pointer_cast<const duty::MatchDuty>(check.duty->shape_data);
}

std::string key_of_load(const Check& check) {
  return fmt::format("{}|{}|{}", check.robot->file.string(), check.duty->file.string(), check.seed);
}

}  // namespace

int Computations::independent_draws(const Check& check) {
  const int games = select::draw_count(*check.duty, check.samples);
  return games > 0 ? games : check.samples;
}

const duty::MatchLoad& Computations::nominal_game(const Check& check) {
  const std::shared_ptr<const duty::MatchDuty> match = match_of(check);
  if (!match) {
    throw base::Failure(base::ExitCode::bad_input,
                        fmt::format("the drive core can drive only a match; {} is {}. Expected a duty of the shape match", check.duty->id,
                                    check.duty->shape));
  }
  return nominal_games_.get(key_of_load(check), [&] { return duty::play_nominal(match->inputs(), *check.robot, check.seed); });
}

const std::vector<duty::WheelDemand>& Computations::demand(const Check& check) {
  if (match_of(check)) {
    return nominal_game(check).wheels;
  }
  return demands_.get(key_of_load(check), [&] { return check.duty->demand(*check.robot, check.seed); });
}

const std::vector<duty::WheelDemand>& Computations::draws(const Check& check) {
  const int count = select::draw_count(*check.duty, check.samples);
  return draws_.get(fmt::format("{}|{}", key_of_load(check), count), [&] {
    std::vector<duty::WheelDemand> draws(static_cast<std::size_t>(count));
    // The nominal game takes as long as several draws, so it is played beside them.
    base::in_parallel(draws.size() + 1, threads_, [&](std::size_t job) {
      if (job == 0) {
        static_cast<void>(demand(check));
      } else {
        draws[job - 1] = check.duty->shape_data->draw(*check.robot, check.seed, job - 1);
      }
    });
    return draws;
  });
}

void Computations::play_games(const Check& check) {
  try {
    static_cast<void>(draws(check));
  } catch (const base::Failure&) {
    return;  // kept
  }
}

const select::MotorEvaluation& Computations::evaluation(const Check& check, const motor::Motor& motor) {
  return evaluations_.get(fmt::format("{}|{}|{}", key_of_load(check), key_of(motor), check.samples), [&] {
    motor::require_sound(motor);
    select::EvaluateOptions options;
    options.samples = check.samples;
    options.seed = check.seed;
    options.threads = threads_;
    options.draws = draws(check);
    return select::evaluate(*check.robot, *check.duty, demand(check), std::span(&motor, 1), options).front();
  });
}

const select::MotorEvaluation& Computations::feasible_evaluation(const Check& check) {
  const select::MotorEvaluation& result = evaluation(check, *check.motor);
  if (result.verdict == select::Verdict::infeasible) {
    throw base::Failure(base::ExitCode::limit_exceeded,
                        fmt::format("{} cannot deliver what the duty demands ({}): it delivers {:.0f} % of the "
                                    "demanded current at the worst moment, and too little for {:.0f} % of the time",
                                    result.motor_id, select::to_string(result.limiting_factor), 100.0 * result.least_torque_share,
                                    100.0 * result.short_time_share));
  }
  return result;
}

const derate::Derating& Computations::derating(const Check& check, const derate::DerateOptions& options) {
  return deratings_.get(fmt::format("{}|{}|{}", check.robot->file.string(), key_of(*check.motor), derate::options_text(options, 0.0)), [&] {
    motor::require_sound(*check.motor);
    derate::DerateOptions with_threads = options;
    with_threads.guarantee.threads = threads_;
    return derate::derate(*check.motor, *check.robot, with_threads);
  });
}

const GuardedDrive& Computations::guarded_drive(const Check& check) {
  const duty::MatchLoad& load = nominal_game(check);
  if (!check.motor->nominal.rotor_inertia_kg_m2) {
    throw base::Failure(base::ExitCode::bad_input, fmt::format("{} has no rotor_inertia, which is needed for the acceleration of a wheel",
                                                               check.motor->file.string()));
  }
  derate::DerateOptions options = check.derate;
  options.hottest_ambient_C = std::max(options.hottest_ambient_C, check.duty->ambient_C.value);
  options.coldest_ambient_C = std::min(options.coldest_ambient_C, check.duty->ambient_C.value);
  options.sensor.reset();  // the drive core has no temperature sensor
  return drives_.get(fmt::format("{}|{}|{}", key_of_load(check), key_of(*check.motor), derate::options_text(options, 0.0)), [&] {
    simulate::MotorGuard guard;
    guard.derating.emplace(derating(check, options));
    guard.guard.emplace(*guard.derating);
    const simulate::GuardedCore core(*check.robot, *check.motor, simulate::GuardUse::shadow, guard);
    const simulate::Game game = simulate::game_of(match_of(check)->inputs(), load);
    simulate::MatchRunOptions run;
    run.ambient_C = check.duty->ambient_C.value;
    run.drive = simulate::real_drive(*check.robot, check.seed);
    const simulate::DriveScore score = simulate::run_match(game, *check.robot, *check.motor, core.config(), run).score;
    if (const std::optional<simulate::DriveProblem> problem = simulate::drive_problem(score)) {
      throw base::Failure(base::ExitCode::limit_exceeded, fmt::format("the match was not driven: {}", simulate::to_string(*problem)));
    }
    return GuardedDrive{score, score.time_s};
  });
}

}  // namespace heatsoak::check
