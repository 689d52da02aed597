#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <initializer_list>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "base/files.h"
#include "cli/command.h"
#include "cli/match_roles.h"
#include "cli/named_files.h"
#include "cli/quantity_option.h"
#include "duty/duty.h"
#include "duty/duty_rows.h"
#include "duty/game_to_demand.h"
#include "duty/match/match_duty.h"
#include "motor/motor.h"
#include "present/duty.h"

namespace heatsoak::commands {
namespace {

struct Options {
  std::string duty;
  std::string log;
  std::string player;
  std::string robot;
  std::string out;
  double every_s = 0.01;
  std::uint64_t seed = 1;
  std::string planner = "jerk_limited";
  std::vector<std::string> given;  ///< options given on the command line
};

/// Throws if an option was given that has no effect in this case, because the user expects it to have one.
void refuse(const Options& options, std::initializer_list<std::string_view> unused, const std::string& why) {
  for (const std::string_view option : unused) {
    if (std::ranges::find(options.given, option) != options.given.end()) {
      throw Failure(ExitCode::bad_input, fmt::format("{} {}", option, why));
    }
  }
}

/// Returns the duty file that accompanies the CSV, so that the next command is `evaluate --duty FILE.toml`.
std::string duty_file(const std::filesystem::path& csv, DutyKind kind, const std::string& summary, const std::string& origin) {
  return fmt::format(
      "summary = {}\norigin = {}\nshape = \"recorded\"\n"
      "ambient = {{ value = \"25 degC\", origin = \"estimated\", derivation = \"not recorded\", range = [\"20 degC\", \"32 degC\"] }}\n\n"
      "[recorded]\nfile = {}\nquantity = \"{}\"\n",
      nlohmann::json(summary).dump(), nlohmann::json(origin).dump(), nlohmann::json(csv.filename().string()).dump(),
      kind == DutyKind::torque ? "torque" : "current");
}

/// Opens the table, whose rows are written as they are produced; nothing without --out.
std::optional<DutyRows> open_table(const Options& options, std::size_t wheel_count, DutyKind kind, Session& session) {
  if (options.out.empty()) {
    return std::nullopt;
  }
  StreamedFile& file = session.stream(options.out);
  return std::optional<DutyRows>(std::in_place, wheel_count, kind, options.every_s, [&file](std::string_view text) { file.write(text); });
}

/// Completes the table, if there is one, and shows the document.
void finish(std::optional<DutyRows>& rows, const Options& options, const std::string& description_text, present::Document document,
            Session& session) {
  if (!rows) {
    session.show(document);
    return;
  }
  rows->finish();
  std::filesystem::path description = options.out;
  description.replace_extension(".toml");
  session.write(description, description_text);
  present::add_duty_files(document, options.out, description.string());
  session.show(document);
}

nlohmann::ordered_json phase_json(const MatchLoad& load) {
  nlohmann::ordered_json phases = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < load.phases.size(); ++i) {
    const PhaseLoad& phase = load.phases[i];
    phases.push_back({{"phase", kPhaseNames[i]},
                      {"time_s", rounded(phase.time_s, 3)},
                      {"duel_s", rounded(phase.duel_s, 3)},
                      {"slip_s", rounded(phase.slip_s, 3)},
                      {"torque_squared_Nm2_s", phase.torque_squared_Nm2_s},
                      {"duel_torque_squared_Nm2_s", phase.duel_torque_squared_Nm2_s}});
  }
  return phases;
}

/// Writes the rows of a duty that is not a match.
ExitCode put_out(const Options& options, const Robot& robot, const Duty& duty, Session& session) {
  const std::vector<WheelDemand> wheels = duty.demand(robot, options.seed);
  std::optional<DutyRows> rows = open_table(options, wheels.size(), duty.kind, session);
  std::vector<LoadBin> row(wheels.size());
  for (std::size_t at = 0; rows && at < wheels.front().bins.size(); ++at) {
    std::ranges::transform(wheels, row.begin(), [at](const WheelDemand& wheel) { return wheel.bins[at]; });
    rows->add(row);
  }
  finish(rows, options, duty_file(options.out, duty.kind, duty.summary, duty.origin),
         present::load_document(duty, wheels.front().duration_s()), session);
  session.answer({{"schema", "heatsoak.duty/1"}, {"duty", duty.id}, {"origin", duty.origin}, {"duration_s", wheels.front().duration_s()}});
  return ExitCode::done;
}

ExitCode generate(const Options& options, const Robot& robot, const Duty& duty, const MatchInputs& inputs, Session& session) {
  const Planner planner = options.planner == "bang_bang" ? Planner::bang_bang : Planner::jerk_limited;
  std::optional<DutyRows> rows = open_table(options, robot.wheels.axis_rad.size(), duty.kind, session);
  MatchObserver observer;
  if (rows) {
    observer = [&rows](const MatchMoment& now) { rows->add(now.step_s, now.wheels->torque_Nm, now.wheels->speed_rad_per_s); };
  }
  const MatchLoad load = play_match(inputs, inputs.nominal(), robot, options.seed, planner, kBin_s, observer);
  const RoleLoads roles = play_roles(inputs, robot, options.seed, planner);
  finish(rows, options, duty_file(options.out, duty.kind, duty.summary, duty.origin),
         present::match_duty_document(duty, robot, kRoleNames[static_cast<std::size_t>(inputs.role)], options.seed, load, roles), session);
  session.answer({{"schema", "heatsoak.duty/1"},
                  {"duty", duty.id},
                  {"robot", robot.id},
                  {"origin", duty.origin},
                  {"seed", options.seed},
                  {"duration_s", rounded(load.duration_s, 3)},
                  {"play_s", rounded(load.play_s, 3)},
                  {"distance_m", rounded(load.distance_m, 1)},
                  {"phases", phase_json(load)},
                  {"roles", role_json(roles)}});
  return ExitCode::done;
}

ExitCode import(const Options& options, const Robot& robot, Session& session) {
  std::optional<DutyRows> rows = open_table(options, robot.wheels.axis_rad.size(), DutyKind::torque, session);
  GameObserver observer;
  if (rows) {
    observer = [&rows](double duration_s, const WheelDemands& wheels) { rows->add(duration_s, wheels.torque_Nm, wheels.speed_rad_per_s); };
  }
  const GameDemand game = demand_of_game(options.log, options.player, robot, kBin_s, observer);
  if (game.wheels.empty()) {
    throw Failure(ExitCode::cannot_answer,
                  fmt::format("{}: no robot is seen long enough to follow its motion\n{}", options.log, fmt::join(game.sentences, "\n")));
  }
  const std::string summary =
      fmt::format("{} of {}, driven by {}", game.player, std::filesystem::path(options.log).filename().string(), robot.name);
  const std::string origin = "measured motion of a recorded game, wheel torques computed from the robot's file";
  finish(rows, options, duty_file(options.out, DutyKind::torque, summary, origin),
         present::recorded_game_document(game, robot, options.log), session);
  session.answer({{"schema", "heatsoak.duty/1"},
                  {"log", options.log},
                  {"player", game.player},
                  {"robot", robot.id},
                  {"duration_s", rounded(game.wheels.front().duration_s(), 3)},
                  {"report", game.sentences}});
  return ExitCode::done;
}

ExitCode run(const Options& options, Session& session) {
  if (options.duty.empty() == options.log.empty()) {
    throw Failure(ExitCode::bad_input, "expected one of --duty and --import (`heatsoak duty --help` shows examples)");
  }
  if (options.duty.empty()) {
    refuse(options, {"--seed", "--planner"}, "is for matches; --import reads a recorded game");
  } else {
    refuse(options, {"--player"}, "is for a recorded game (--import)");
  }
  if (options.out.empty()) {
    refuse(options, {"--every"}, "is for the rows of a table; expected --out FILE.csv with it");
  }
  NamedFiles named(session.folders());
  const std::optional<Robot> robot = named.robot(options.robot);
  const std::optional<Duty> duty = options.log.empty() ? named.duty(options.duty) : std::nullopt;
  named.throw_if_any();
  if (!duty) {
    return import(options, *robot, session);
  }
  const auto match = std::dynamic_pointer_cast<const MatchDuty>(duty->shape_data);
  if (match) {
    return generate(options, *robot, *duty, match->inputs(), session);
  }
  refuse(options, {"--seed", "--planner"}, fmt::format("is for matches; {} is {}", duty->id, duty->shape));
  return put_out(options, *robot, *duty, session);
}

}  // namespace

Command duty_command() {
  return {.name = {},
          .summary = "Generates a duty (a match with its phases and where heat comes from), or turns a recorded game into one",
          .example = "heatsoak duty --duty division_a_match --robot roboteam_twente_v2024 --seed 1 --out match.csv",
          .declare = [](CLI::App& app, Session& session) -> std::function<ExitCode()> {
            const auto options = std::make_shared<Options>();
            app.add_option("--duty", options->duty, "id (see `heatsoak list duties`) or file")->type_name("D");
            app.add_option("--import", options->log,
                           "recorded game: CSV (t_s, team, robot_id, x_m, y_m, yaw_rad) or SSL_LOG_FILE (.log, .log.gz)")
                ->type_name("LOG");
            app.add_option("--player", options->player, "of the recorded game, \"yellow 3\"; the busiest one unless given")->type_name("P");
            app.add_option("--robot", options->robot, "id (see `heatsoak list robots`) or file")->required()->type_name("R");
            add_table(app, options->out, "torque and speed of every wheel, and FILE.toml beside it to evaluate");
            add_quantity(app, "--every", options->every_s,
                         {"every", "s", Range::between(1e-3, 10.0), "time between two rows; 0.01 s unless given"});
            add_seed(app, options->seed, "of a match; same seed, same game");
            app.add_option("--planner", options->planner, "of a match")
                ->check(CLI::IsMember({"jerk_limited", "bang_bang"}))
                ->type_name("P")
                ->capture_default_str();
            session.add_data_option(app);
            session.add_answer_options(app);
            return [options, &app, &session] {
              for (const CLI::Option* each : app.get_options([](const CLI::Option* option) { return option->count() > 0; })) {
                options->given.push_back(each->get_name());
              }
              return run(*options, session);
            };
          }};
}

}  // namespace heatsoak::commands
