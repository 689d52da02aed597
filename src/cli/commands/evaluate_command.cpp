#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/closed_loop_json.h"
#include "cli/command.h"
#include "cli/condition_option.h"
#include "cli/default_spreads.h"
#include "cli/named_files.h"
#include "cli/quantity_option.h"
#include "cli/verdict_chart.h"
#include "duty/duty.h"
#include "duty/match/match_duty.h"
#include "motor/conditions.h"
#include "motor/motor.h"
#include "present/closed_loop.h"
#include "present/evaluation.h"
#include "present/motor_notes.h"
#include "report/chart.h"
#include "robot/assumed_friction.h"
#include "robot/robot.h"
#include "select/decision.h"
#include "select/evaluate.h"

namespace heatsoak::commands {
namespace {

using Json = nlohmann::ordered_json;

/// Values of --fail-on in the order of Verdict, without pass. Exit code 1 from the given verdict on.
const std::vector<std::string> kFailOn{"marginal", "fail", "infeasible"};

struct Options {
  std::string robot;
  std::string duty;
  std::optional<std::string> motors;
  std::string model;
  std::string plot;
  std::map<std::string, std::string> conditions;
  EvaluateOptions evaluate;
  bool suggests = false;
  std::optional<int> samples;  ///< empty: first_samples(), and more until the verdicts are decided
  bool is_closed_loop = false;
  int games = 3;
  std::string guard = "shadow";
  std::string fail_on = "fail";
};

/// An existing file whose name contains commas is one motor, not a list.
std::vector<std::string> listed_motors(const Options& options) {
  if (!options.motors) {
    return options.model.empty() ? std::vector<std::string>{"all"} : std::vector<std::string>{};
  }
  std::error_code unreadable;
  if (options.motors->find(',') == std::string::npos || std::filesystem::exists(*options.motors, unreadable)) {
    return {*options.motors};
  }
  std::vector<std::string> names = CLI::detail::split(*options.motors, ',');
  std::ranges::for_each(names, [](std::string& name) { CLI::detail::trim(name); });
  return names;
}

/// A model replaces the motor from which its fit started; without --motors it is evaluated alone.
std::vector<Motor> read_motors(const Options& options, NamedFiles& named) {
  std::vector<std::string> names;
  for (const std::string& name : listed_motors(options)) {
    const std::vector<std::string> all = name == "all" ? ids_in(named.folders().motors) : std::vector<std::string>{name};
    names.insert(names.end(), all.begin(), all.end());
  }
  std::vector<Motor> motors;
  const std::optional<Motor> model = options.model.empty() ? std::nullopt : named.motor(options.model);
  if (model) {
    motors.push_back(under(*model, options.conditions));
  }
  std::set<std::filesystem::path> taken;
  for (const std::string& name : names) {
    const std::optional<std::filesystem::path> file = named.motor_file(name);
    const bool is_replaced = file && model && model->fit && model->fit->motor == file->stem();
    if (!file || is_replaced || !taken.insert(*file).second) {
      continue;
    }
    const auto same =
        std::ranges::find_if(taken, [&](const std::filesystem::path& other) { return other != *file && other.stem() == file->stem(); });
    if (same != taken.end()) {
      throw Failure(ExitCode::bad_input, fmt::format("{} and {} are two motors with the same id, '{}'; rename one of the files",
                                                     same->string(), file->string(), file->stem().string()));
    }
    if (const std::optional<Motor> motor = named.motor(name)) {
      motors.push_back(options.model.empty() ? under(*motor, options.conditions) : *motor);
    }
  }
  return motors;
}

/// Returns the sound motors of the database, which are candidates to replace the robot's motor.
std::vector<Motor> motors_of_database(const Options& options, const DataFolders& folders) {
  std::vector<Motor> motors;
  for (const std::string& id : ids_in(folders.motors)) {
    NamedFiles named(folders);  // a file with problems is no candidate
    if (const std::optional<Motor> motor = named.motor(id)) {
      motors.push_back(under(*motor, options.conditions));
    }
  }
  return motors;
}

nlohmann::ordered_json json(const Spread95& peak) {
  return {
      {"nominal", rounded(peak.nominal, 2)}, {"p05", rounded(peak.p05, 2)}, {"p50", rounded(peak.p50, 2)}, {"p95", rounded(peak.p95, 2)}};
}

nlohmann::ordered_json json(const MotorEvaluation& each) {
  const auto optional = [](const std::optional<double>& value, int decimals) {
    return value ? rounded(*value, decimals) : nlohmann::ordered_json();
  };
  const auto interval = [](const std::optional<Interval95>& value, int decimals) {
    return value ? nlohmann::ordered_json{rounded(value->low, decimals), rounded(value->high, decimals)} : nlohmann::ordered_json();
  };
  return {{"id", each.motor_id},
          {"winding_limit_C", rounded(each.winding_limit_C, 2)},
          {"winding_peak_C", json(each.winding_peak_C)},
          {"stator_peak_C", json(each.stator_peak_C)},
          {"samples", each.samples},
          {"samples_needed", each.samples_needed ? nlohmann::ordered_json(*each.samples_needed) : nlohmann::ordered_json()},
          {"probability_over_limit", rounded(each.probability_over_limit, 4)},
          {"probability_ci95", interval(each.probability_interval, 4)},
          {"winding_p95_ci95_C", interval(each.winding_p95_interval_C, 2)},
          {"time_to_limit_s", optional(each.time_to_limit_s, 3)},
          {"current_rms_A", rounded(each.current_rms_A, 4)},
          {"verdict", to_string(each.verdict)},
          {"limiting_factor", to_string(each.limiting_factor)},
          {"data_quality", each.data_quality},
          {"wheel", each.wheel},
          {"margin_K", rounded(each.margin_K, 2)},
          {"stator_margin_K", optional(each.stator_margin_K, 2)},
          {"margin_A", optional(each.margin_A, 4)},
          {"stator_limit_C", optional(each.stator_limit_C, 2)},
          {"delivered_share", rounded(each.least_torque_share, 4)},
          {"short_time_share", rounded(each.short_time_share, 4)},
          {"short_probability", rounded(each.short_probability, 4)},
          {"voltage_needed_V", rounded(each.highest_voltage_V, 3)},
          {"runaway", each.destroyed}};
}

ExitCode run(Options& options, Session& session) {
  NamedFiles named(session.folders());
  const std::optional<Robot> robot_read = named.robot(options.robot);
  const std::optional<Duty> duty_read = named.duty(options.duty);
  const std::vector<Motor> motors = read_motors(options, named);
  named.throw_if_any();
  const Duty& duty = *duty_read;
  if (motors.empty()) {
    throw Failure(ExitCode::bad_input, fmt::format("there is no motor file in {}", named.folders().motors.string()));
  }
  const auto match = std::dynamic_pointer_cast<const MatchDuty>(duty.shape_data);
  const Robot robot = match ? with_assumed_friction(*robot_read) : *robot_read;
  if (options.is_closed_loop && !match) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("--closed-loop can drive only a match; {} is {}. Expected a duty of the shape match, or no "
                              "--closed-loop",
                              duty.id, duty.shape));
  }
  if (!options.is_closed_loop && options.guard != Options{}.guard) {
    throw Failure(ExitCode::bad_input, "--guard is for --closed-loop; expected both or none");
  }
  if (const int most = most_samples_at_all(duty.shape_data->has_unknowns()); options.samples.value_or(0) > most) {
    throw Failure(ExitCode::bad_input, fmt::format("--samples {}: a game is played for every eight samples on {}; expected at most {}",
                                                   *options.samples, duty.id, most));
  }
  options.evaluate.with_curves = true;
  options.evaluate.with_bands = !options.plot.empty();
  options.evaluate.samples = options.samples.value_or(first_samples(duty));
  const int most = options.samples.value_or(most_samples(duty));
  const std::vector<WheelDemand> wheels = duty.demand(robot, options.evaluate.seed);
  std::vector<WheelDemand> draws;
  std::vector<MotorEvaluation> results = evaluate_until_decided(robot, duty, wheels, motors, options.evaluate, most, draws,
                                                                [](const char* what) { return progress_bar(what); });
  std::vector<ClosedLoopRank> ranks;
  if (options.is_closed_loop) {
    const GameDriveOptions drive{
        options.games, options.evaluate.seed,   duty.ambient_C.value, options.guard == "off" ? GuardUse::off : GuardUse::shadow,
        false,         options.evaluate.threads};
    ranks = rank_closed_loop(drive_games(robot, match->inputs(), motors, drive, progress_bar("driving games")), results);
  }
  present::Document document = present::evaluation_document(results, {robot, duty, wheels.front(), options.evaluate.seed, draws.size()});
  present::add_motor_notes(document, motors);
  present::add_lines(document.notes, present::default_spreads_text(motors), present::Severity::note);
  std::vector<ChangeEffect> changes;
  // The motor that the robot is built with if it is among the results, else the best one.
  const auto own = std::ranges::find(results, robot.drive.motor, &MotorEvaluation::motor_id);
  const MotorEvaluation& subject = own == results.end() ? results.front() : *own;
  const bool suggests = options.suggests || subject.verdict != Verdict::pass;
  if (suggests) {
    const std::string id = subject.motor_id;
    changes = effects_of_changes(robot, duty, *std::ranges::find(motors, id, &Motor::id), motors_of_database(options, session.folders()),
                                 options.evaluate.seed, options.evaluate.threads, progress_bar("trying changes"));
    present::add_changes(document, changes, id);
  }
  present::add_lines(document.notes, assumed_friction_text(robot), present::Severity::warning);
  if (options.is_closed_loop) {
    present::add_closed_loop(document, ranks, options.games, options.evaluate.seed);
  }
  if (!options.plot.empty()) {
    session.write(options.plot, draw_picture(verdict_chart(results, robot, duty), options.plot));
    document.add_file(options.plot);
  }
  session.show(document);
  nlohmann::ordered_json answer{{"schema", "heatsoak.evaluate/1"},     {"robot", robot.id},
                                {"conditions", options.conditions},    {"duty", duty.id},
                                {"duty_origin", duty.origin},          {"seed", options.evaluate.seed},
                                {"samples", options.evaluate.samples}, {"duty_draws", draws.size()}};
  answer["default_spreads"] = default_spreads_json(motors);
  if (suggests) {
    answer["changes"] = nlohmann::ordered_json::array();
    for (const ChangeEffect& each : changes) {
      answer["changes"].push_back({{"quantity", name_of(each.quantity)},
                                   {"unit", unit_of(each.quantity)},
                                   {"from", each.other_motor.empty() ? rounded(each.before, 6) : Json(subject.motor_id)},
                                   {"to", each.other_motor.empty() ? rounded(each.before * each.factor, 6) : Json(each.other_motor)},
                                   {"saved_K", rounded(each.saved_K, 2)},
                                   {"standard_error_K", rounded(each.standard_error_K, 2)},
                                   {"deliverable", each.is_deliverable}});
    }
  }
  answer["is_friction_assumed"] = robot.friction.is_assumed;
  const Verdict least_bad = static_cast<Verdict>(std::ranges::find(kFailOn, options.fail_on) - kFailOn.begin() + 1);
  bool exceeded = false;
  answer["motors"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < results.size(); ++i) {
    answer["motors"].push_back(json(results[i]));
    Verdict verdict = results[i].verdict;
    if (options.is_closed_loop) {
      answer["motors"].back()["closed_loop"] = closed_loop_json(ranks[i], options.evaluate.seed);
      verdict = ranks[i].verdict;
    }
    exceeded = exceeded || verdict >= least_bad;
  }
  session.answer(answer);
  return exceeded ? ExitCode::limit_exceeded : ExitCode::done;
}

}  // namespace

Command evaluate_command() {
  return {
      .name = {},
      .summary = "Ranks motors on one duty of one robot: peak temperatures with uncertainty, what limits each; exit 1 if one of them fails",
      .example =
          "heatsoak evaluate --robot roboteam_twente_v2024 --duty division_a_match --motors "
          "maxon_ecx_flat_42m_24v,nanotec_df45l024048_a2 --plot verdict.svg",
      .declare = [](CLI::App& app, Session& session) -> std::function<ExitCode()> {
        const auto options = std::make_shared<Options>();
        app.add_option("--robot", options->robot, "id (see `heatsoak list robots`) or file")->required()->type_name("R");
        app.add_option("--duty", options->duty, "id (see `heatsoak list duties`) or file")->required()->type_name("D");
        app.add_option("--motors", options->motors, "ids or files separated by commas, or all")->type_name("M,M")->default_str("all");
        app.add_option("--model", options->model,
                       "a calibrated motor (`heatsoak calibrate --out FILE`) in place of the one it was fitted from")
            ->type_name("FILE.toml");
        add_conditions(app, options->conditions);
        app.add_option("--samples", options->samples,
                       "draws of every declared tolerance and range, one game for every eight on a match; 0: nominal only; if not given, "
                       "about a hundred, and more until the verdicts are decided")
            ->check(whole_number(1'000'000))
            ->type_name("N");
        app.add_flag("--closed-loop", options->is_closed_loop,
                     "on a match: the drive core drives games with each motor, with slip, battery sag and real sensing; ranks by them, and "
                     "exit 1 follows them");
        app.add_option("--guard", options->guard,
                       "of --closed-loop: shadow counts for how long the motor's thermal guard would have limited it; off leaves that out, "
                       "which saves some seconds per motor")
            ->check(CLI::IsMember({"off", "shadow"}))
            ->type_name("G")
            ->capture_default_str();
        app.add_option("--games", options->games, "of --closed-loop, with successive seeds")
            ->check(CLI::Range(1, 1000))
            ->capture_default_str();
        app.add_flag(
            "--suggest", options->suggests,
            "list the changes of the robot that cool its motor most also if it passes: acceleration, jerk, speed, mass, wheels, gear");
        app.add_option("--fail-on", options->fail_on, "exit 1 if a motor's verdict is this or worse: marginal, fail, infeasible")
            ->check(CLI::IsMember(kFailOn))
            ->type_name("VERDICT")
            ->capture_default_str();
        add_seed(app, options->evaluate.seed, "of the draws and games; same seed, same bytes");
        app.add_option("--threads", options->evaluate.threads, "0: all cores; the result does not depend on it")
            ->check(whole_number(1024))
            ->capture_default_str();
        add_picture(app, options->plot, "picture of stator and winding temperature over time");
        session.add_data_option(app);
        session.add_answer_options(app);
        return [options, &session] { return run(*options, session); };
      }};
}

}  // namespace heatsoak::commands
