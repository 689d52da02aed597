#include "simulate/game_drives.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>

#include "base/diagnostic.h"

namespace heatsoak::simulate {

namespace {

/// Needs one or more values.
GameSpread spread_of(const std::vector<double>& values) {
  const auto [low, high] = std::ranges::minmax(values);
  return {values.front(), low, high};
}

}  // namespace

GameSpread GameDrives::spread(double DriveScore::*value) const {
  std::vector<double> values;
  std::ranges::transform(games, std::back_inserter(values), [value](const DriveScore& each) { return each.*value; });
  return spread_of(values);
}

std::optional<GameSpread> GameDrives::spread(std::optional<double> DriveScore::*value) const {
  std::vector<double> values;
  for (const DriveScore& each : games) {
    if (each.*value) {
      values.push_back(*(each.*value));
    }
  }
  return values.empty() ? std::nullopt : std::optional(spread_of(values));
}

namespace {

const std::string kPlaying = "playing the games to drive";
const std::string kGuarding = "making thermal guards";
const std::string kDriving = "driving games";

/// Returns why the drive core cannot drive this motor, or nothing. A robot file without a needed table is an error for all motors.
std::optional<NotDriven> why_not_driven(const robot::Robot& robot, const motor::Motor& motor, GuardUse use, const MotorGuard& guard) {
  if (!motor.nominal.rotor_inertia_kg_m2) {
    return NoRotorInertia{};
  }
  try {
    const GuardedCore core(robot, motor, use, guard);
  } catch (const base::Failure& failure) {
    if (failure.code() != base::ExitCode::bad_input || !failure.diagnostics().empty()) {
      throw;
    }
    return failure;
  }
  return std::nullopt;
}

}  // namespace

std::vector<GameDrives> drive_games(const robot::Robot& robot, const duty::MatchInputs& inputs, std::span<const motor::Motor> motors,
                                    const GameDriveOptions& options, const base::JobProgress& progress) {
  const auto games = static_cast<std::size_t>(options.games);
  std::vector<Game> played(games);
  base::in_parallel(games, options.threads, 0, games, progress.begin(kPlaying),
                    [&](std::size_t i) { played[i] = play_game(inputs, robot, options.seed + i); });
  std::vector<GameDrives> drives(motors.size());
  std::vector<MotorGuard> guards(motors.size());
  base::in_parallel(motors.size(), options.threads, 0, motors.size(), progress.begin(kGuarding), [&](std::size_t i) {
    drives[i].motor_id = motors[i].id;
    drives[i].why_none = why_not_driven(robot, motors[i], GuardUse::off, {});
    if (!drives[i].why_none && options.guard != GuardUse::off) {
      guards[i] = make_guard(motors[i], robot, options.ambient_C, options.threads);
      drives[i].is_guarded = guards[i].guard.has_value();
      drives[i].why_no_guard = guards[i].why_none;
      drives[i].why_none = why_not_driven(robot, motors[i], options.guard, guards[i]);
    }
    drives[i].games.resize(drives[i].why_none ? 0 : games);
  });
  const std::size_t jobs = motors.size() * games;
  // A game takes seconds, and few are driven at a time, so the parts of each count.
  constexpr std::size_t kParts = 1000;
  const base::Progress driving = progress.begin(kDriving);
  std::atomic<std::size_t> driven_parts = 0;
  base::in_parallel(jobs, options.threads, [&](std::size_t job) {
    std::size_t parts = 0;
    const auto report = [&](std::size_t done, std::size_t all) {
      const std::size_t now = kParts * done / all;
      driven_parts += now - parts;
      parts = now;
      if (driving) {
        driving(driven_parts, kParts * jobs);
      }
    };
    const std::size_t motor = job / games;
    const std::size_t game = job % games;
    if (!drives[motor].why_none) {
      const GuardedCore core(robot, motors[motor], options.guard, guards[motor]);
      MatchRunOptions run;
      run.ambient_C = options.ambient_C;
      run.drive = options.is_sensing_ideal ? ideal_drive() : real_drive(robot, options.seed + game);
      run.progress = report;
      drives[motor].games[game] = run_match(played[game], robot, motors[motor], core.config(), run).score;
    }
    report(1, 1);
  });
  return drives;
}

std::vector<base::JobPhase> drive_phases(std::size_t motors, const GameDriveOptions& options) {
  const auto count = static_cast<double>(motors);
  const double guard_s = options.guard == GuardUse::off ? 0.0 : kGuard_s;
  return {{kPlaying, kPlayedGame_s * options.games}, {kGuarding, guard_s * count}, {kDriving, kDrive_s / 2.0 * count * options.games}};
}

}  // namespace heatsoak::simulate
