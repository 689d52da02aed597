#include "check/computations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "base/lanes.h"
#include "duty/match/match_duty.h"
#include "motor/default_spread.h"
#include "select/round_plan.h"
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

// Usual durations in s on two cores.

double derating_s(const Check& check) {
  constexpr double kMotor_s = 0.005;
  return kMotor_s * check.derate.guarantee.samples;
}

bool needs(const Check& check, Setting setting) {
  return std::ranges::any_of(check.limits, [setting](const Limit& limit) {
    return std::ranges::find(limit.type->needs, setting) != limit.type->needs.end() ||
           std::ranges::find(limit.type->takes, setting) != limit.type->takes.end();
  });
}

}  // namespace

base::Progress Computations::reporting(const Check& check, double all_s) const {
  if (!worked_) {
    return {};
  }
  return [this, &check, all_s, last = 0.0](std::size_t done, std::size_t total) mutable {
    const double share = static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(1, total));
    if (share > last) {
      worked_(check, all_s * (share - last));
      last = share;
    }
  };
}

bool needs_drive(const ThresholdType& type) {
  const auto has = [](const std::vector<Setting>& all, Setting one) { return std::ranges::find(all, one) != all.end(); };
  return has(type.needs, Setting::duty) && has(type.takes, Setting::derate);
}

std::vector<UsualWork> Computations::usual_work(const Check& check) {
  constexpr double kOther_s = 0.05;
  constexpr double kLog_s = 0.2;
  using Kind = UsualWork::Kind;
  std::vector<UsualWork> all{
      {Kind::other, fmt::format("check|{}", check.name), kOther_s + kLog_s * static_cast<double>(check.logs.size())}};
  if (needs(check, Setting::samples) && check.robot && check.duty) {
    const int games = select::draw_count(*check.duty, check.samples);
    if (games > 0) {
      all.push_back({Kind::games, fmt::format("games|{}|{}", key_of_load(check), games), select::kDraw_s * games});
    }
    std::vector<const motor::Motor*> motors;
    std::ranges::transform(check.against, std::back_inserter(motors), [](const motor::Motor& each) { return &each; });
    if (check.motor) {
      motors.push_back(&*check.motor);
    }
    for (const motor::Motor* each : motors) {
      all.push_back({Kind::other, fmt::format("evaluation|{}|{}|{}", key_of_load(check), key_of(*each), check.samples),
                     select::evaluation_work_s(1.0, check.samples)});
    }
  }
  const auto drives = [](const Limit& limit) { return needs_drive(*limit.type); };
  if (needs(check, Setting::derate) && check.robot && check.motor) {
    if (!std::ranges::all_of(check.limits, drives)) {
      all.push_back(
          {Kind::other,
           fmt::format("derating|{}|{}|{}", check.robot->file.string(), key_of(*check.motor), derate::options_text(check.derate, 0.0)),
           derating_s(check)});
    }
    if (check.duty && std::ranges::any_of(check.limits, drives)) {
      all.push_back({Kind::drive, fmt::format("drive|{}|{}", key_of_load(check), key_of(*check.motor)),
                     derating_s(check) + simulate::kDrive_s + simulate::kPlayedGame_s});
    }
  }
  return all;
}

int Computations::independent_draws(const Check& check) {
  const int games = select::draw_count(*check.duty, check.samples);
  return games > 0 ? games : check.samples;
}

namespace {

std::shared_ptr<const duty::MatchDuty> required_match(const Check& check) {
  std::shared_ptr<const duty::MatchDuty> match = match_of(check);
  if (!match) {
    throw NotEvaluated(DutyIsNoMatch{check.duty->id, std::string(check.duty->shape)});
  }
  return match;
}

}  // namespace

const duty::MatchLoad& Computations::nominal_game(const Check& check) {
  const std::shared_ptr<const duty::MatchDuty> match = required_match(check);
  return nominal_games_.get(key_of_load(check), [&] { return duty::play_nominal(match->inputs(), *check.robot, check.seed); });
}

const std::vector<duty::WheelDemand>& Computations::demand(const Check& check) {
  if (match_of(check)) {
    return nominal_game(check).wheels;
  }
  return demands_.get(key_of_load(check), [&] { return check.duty->demand(*check.robot, check.seed); });
}

const std::vector<duty::WheelDemand>& Computations::draws(const Check& check, const base::Progress& progress) {
  const int count = select::draw_count(*check.duty, check.samples);
  return draws_.get(fmt::format("{}|{}", key_of_load(check), count), [&] {
    std::vector<duty::WheelDemand> draws(static_cast<std::size_t>(count));
    // The nominal game takes as long as several draws, so it is played beside them.
    base::in_parallel(draws.size() + 1, threads_, 0, draws.size() + 1, progress, [&](std::size_t job) {
      if (job == 0) {
        static_cast<void>(demand(check));
      } else {
        draws[job - 1] = check.duty->shape_data->draw(*check.robot, check.seed, job - 1);
      }
    });
    return draws;
  });
}

void Computations::play_games(const Check& check, const base::Progress& progress) {
  try {
    static_cast<void>(draws(check, progress));
  } catch (const base::Failure&) {
    return;  // kept
  } catch (const NotEvaluated&) {
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
    return select::evaluate(*check.robot, *check.duty, demand(check), std::span(&motor, 1), options,
                            reporting(check, select::evaluation_work_s(1.0, check.samples)))
        .front();
  });
}

const select::MotorEvaluation& Computations::feasible_evaluation(const Check& check) {
  const select::MotorEvaluation& result = evaluation(check, *check.motor);
  if (result.verdict == select::Verdict::infeasible) {
    throw NotEvaluated(DemandNotDelivered{result.motor_id, result.limiting_factor, result.least_torque_share, result.short_time_share});
  }
  return result;
}

const derate::Derating& Computations::derating(const Check& check, const derate::DerateOptions& options) {
  return deratings_.get(fmt::format("{}|{}|{}", check.robot->file.string(), key_of(*check.motor), derate::options_text(options, 0.0)), [&] {
    motor::require_sound(*check.motor);
    derate::DerateOptions with_threads = options;
    with_threads.guarantee.threads = threads_;
    return derate::derate(*check.motor, *check.robot, with_threads, reporting(check, derating_s(check)));
  });
}

const GuardedDrive& Computations::guarded_drive(const Check& check) {
  const std::shared_ptr<const duty::MatchDuty> match = required_match(check);
  if (!check.motor->nominal.rotor_inertia_kg_m2) {
    throw NotEvaluated(RotorInertiaMissing{check.motor->file});
  }
  derate::DerateOptions options = check.derate;
  options.hottest_ambient_C = std::max(options.hottest_ambient_C, check.duty->ambient_C.value);
  options.coldest_ambient_C = std::min(options.coldest_ambient_C, check.duty->ambient_C.value);
  options.sensor.reset();  // the drive core has no temperature sensor
  return drives_.get(fmt::format("{}|{}|{}", key_of_load(check), key_of(*check.motor), derate::options_text(options, 0.0)), [&] {
    simulate::MotorGuard guard;
    guard.derating.emplace(derating(check, options));
    guard.guard.emplace(*guard.derating);
    const duty::MatchLoad& load = nominal_game(check);  // after the derating, because the drawn games beside it come with this game
    const simulate::GuardedCore core(*check.robot, *check.motor, simulate::GuardUse::shadow, guard);
    const simulate::Game game = simulate::game_of(match->inputs(), load);
    simulate::MatchRunOptions run;
    run.ambient_C = check.duty->ambient_C.value;
    run.drive = simulate::real_drive(*check.robot, check.seed);
    run.progress = reporting(check, simulate::kDrive_s);
    const simulate::DriveScore score = simulate::run_match(game, *check.robot, *check.motor, core.config(), run).score;
    if (const std::optional<simulate::DriveProblem> problem = simulate::drive_problem(score)) {
      throw NotEvaluated(MatchNotDriven{*problem});
    }
    return GuardedDrive{score, score.time_s};
  });
}

}  // namespace heatsoak::check
