#include "duty/make_duty.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "base/diagnostic.h"
#include "duty/match/match_duty.h"
#include "input/toml_text.h"

namespace heatsoak::duty {
namespace {

const std::string kGame = "playing the game";
const std::string kRoles = "playing it in every role";

/// Returns the writer of the table; nothing if the job has none.
std::optional<DutyRows> table_of(const DutyJob& job, std::size_t wheel_count, DutyKind kind) {
  return job.put_table ? std::optional<DutyRows>(std::in_place, wheel_count, kind, job.every_s, job.put_table) : std::nullopt;
}

PrescribedLoad put_out(const DutyJob& job, const Duty& duty) {
  if (job.seed || job.planner) {
    throw base::Failure(base::ExitCode::bad_input,
                        fmt::format("{} is for matches; {} is {}", job.seed ? "--seed" : "--planner", duty.id, duty.shape));
  }
  const std::vector<WheelDemand> wheels = duty.demand(job.robot, job.seed.value_or(1));
  std::optional<DutyRows> rows = table_of(job, wheels.size(), duty.kind);
  if (rows) {
    std::vector<LoadBin> row(wheels.size());
    for (std::size_t at = 0; at < wheels.front().bins.size(); ++at) {
      std::ranges::transform(wheels, row.begin(), [at](const WheelDemand& wheel) { return wheel.bins[at]; });
      rows->add(row);
    }
    rows->finish();
  }
  return {wheels.front().duration_s()};
}

GeneratedMatch generate(const DutyJob& job, const Duty& duty, const MatchInputs& inputs, const base::JobProgress& progress) {
  const Planner planner = job.planner.value_or(Planner::jerk_limited);
  GeneratedMatch match{.role = inputs.role, .seed = job.seed.value_or(1), .load = {}, .roles = {}};
  std::optional<DutyRows> rows = table_of(job, job.robot.wheels.axis_rad.size(), duty.kind);
  MatchObserver observer;
  if (rows) {
    observer = [&rows](const MatchMoment& now) { rows->add(now.step_s, now.wheels->torque_Nm, now.wheels->speed_rad_per_s); };
  }
  constexpr double kGame_s = 0.5;
  progress.expect({{kGame, (rows ? 2.0 : 1.0) * kGame_s}, {kRoles, kGame_s * static_cast<double>(match.roles.size())}});
  progress.begin(kGame);
  match.load = play_match(inputs, inputs.nominal(), job.robot, match.seed, planner, kBin_s, observer);
  match.roles = play_roles(inputs, job.robot, match.seed, planner, progress.begin(kRoles));
  if (rows) {
    rows->finish();
  }
  return match;
}

GameDemand imported_game(const DutyJob& job, const base::JobProgress& progress) {
  std::optional<DutyRows> rows = table_of(job, job.robot.wheels.axis_rad.size(), DutyKind::torque);
  GameObserver observer;
  if (rows) {
    observer = [&rows](double duration_s, const robot::WheelDemands& wheels) {
      rows->add(duration_s, wheels.torque_Nm, wheels.speed_rad_per_s);
    };
  }
  GameDemand game = demand_of_game(job.log, job.player, job.robot, kBin_s, observer, progress);
  if (game.wheels.empty()) {
    throw GameNotUsable(base::ExitCode::cannot_answer, fmt::format("{}: no robot is seen long enough to follow its motion", job.log),
                        std::move(game));
  }
  if (rows) {
    rows->finish();
  }
  return game;
}

}  // namespace

DutyAnswer make_duty(const DutyJob& job, const base::JobProgress& progress) {
  DutyAnswer answer{job.robot, job.duty, job.log, {}};
  if (!job.duty) {
    answer.content = imported_game(job, progress);
  } else if (const auto match = std::dynamic_pointer_cast<const MatchDuty>(job.duty->shape_data)) {
    answer.content = generate(job, *job.duty, match->inputs(), progress);
  } else {
    answer.content = put_out(job, *job.duty);
  }
  return answer;
}

std::string duty_file(const DutyAnswer& answer, const std::filesystem::path& csv) {
  const auto* const game = std::get_if<GameDemand>(&answer.content);
  const std::string summary =
      game ? fmt::format("{} of {}, driven by {}", game->player, std::filesystem::path(answer.log).filename().string(), answer.robot.name)
           : answer.duty->summary;
  const std::string origin =
      game ? "measured motion of a recorded game, wheel torques computed from the robot's file" : answer.duty->origin;
  const bool is_torque = game || answer.duty->kind == DutyKind::torque;
  return input::with_short_lines(fmt::format(
      "summary = {}\norigin = {}\nshape = \"recorded\"\n"
      "ambient = {{ value = \"25 degC\", origin = \"estimated\", derivation = \"not recorded\", range = [\"20 degC\", \"32 degC\"] }}\n\n"
      "[recorded]\nfile = {}\nquantity = \"{}\"\n",
      input::toml_text(summary), input::toml_text(origin), input::toml_text(csv.filename().string()), is_torque ? "torque" : "current"));
}

}  // namespace heatsoak::duty
