#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "cli/command.h"
#include "cli/condition_option.h"
#include "cli/jerk_sweep.h"
#include "cli/match_simulation.h"
#include "cli/named_files.h"
#include "cli/quantity_option.h"
#include "cli/verdict_chart.h"
#include "motor/conditions.h"
#include "present/match.h"
#include "report/chart.h"
#include "robot/assumed_friction.h"
#include "select/trace.h"

namespace heatsoak::commands {
namespace {

struct Options {
  std::string motor;
  std::string model;
  std::string robot;
  std::string duty;
  std::string out;
  std::string plot;
  std::string planner = "jerk_limited";
  bool jerk_sweep = false;
  double every_s = 1.0;
  std::uint64_t seed = 1;
  std::string guard = "shadow";
  std::string sensing = "real";
  std::map<std::string, std::string> conditions;
};

nlohmann::ordered_json balance_json(const Trace& trace) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const BookedHeat& each : trace.balance) {
    rows.push_back({{"effect", each.effect}, {"node", each.node}, {"mean_W", rounded(each.mean_W, 6)}});
  }
  return rows;
}

/// Simulates a prescribed load of one wheel.
ExitCode run_load(const Options& options, const Robot& robot, const Motor& motor, const Duty& duty, Session& session) {
  if (options.planner != "jerk_limited") {
    throw Failure(ExitCode::bad_input, fmt::format("--planner is for matches; {} is {}", duty.id, duty.shape));
  }
  const Options usual;
  if (options.guard != usual.guard || options.sensing != usual.sensing) {
    throw Failure(ExitCode::bad_input,
                  fmt::format("--guard and --sensing are for matches, which the drive core drives; {} is {}", duty.id, duty.shape));
  }
  constexpr double kMostRows = 5e6;  // about 1 GB
  const std::vector<WheelDemand> wheels = duty.demand(robot, options.seed);
  const double duration_s = wheels.front().duration_s();
  if (duration_s / options.every_s > kMostRows) {
    throw Failure(ExitCode::bad_input, fmt::format("--every {} s makes more than {:.0f} rows out of {:.0f} s; expected a longer time",
                                                   options.every_s, kMostRows, duration_s));
  }
  const std::vector<Motor> one{motor};
  EvaluateOptions nominal;
  nominal.samples = 0;
  nominal.with_curves = !options.plot.empty();
  const std::vector<MotorEvaluation> results = evaluate(robot, duty, wheels, one, nominal);
  const MotorEvaluation& result = results.front();
  const Trace trace = run_trace(robot, duty, *std::ranges::find(wheels, result.wheel, &WheelDemand::wheel), motor, options.every_s);
  if (!options.out.empty()) {
    session.write(options.out, to_csv(trace));
  }
  if (!options.plot.empty()) {
    session.write(options.plot, draw_picture(verdict_chart(results, robot, duty), options.plot));
  }
  present::Document document = present::load_simulation_document(result, trace, robot, motor, duty, duration_s);
  document.add_file(options.out);
  document.add_file(options.plot);
  session.show(document);
  session.answer({{"schema", "heatsoak.simulate/1"},
                  {"motor", motor.id},
                  {"conditions", motor.assumed},
                  {"robot", robot.id},
                  {"duty", duty.id},
                  {"duty_origin", duty.origin},
                  {"wheel", result.wheel},
                  {"winding_peak_C", rounded(result.winding_peak_C.nominal, 3)},
                  {"stator_peak_C", rounded(result.stator_peak_C.nominal, 3)},
                  {"winding_limit_C", rounded(result.winding_limit_C, 2)},
                  {"current_rms_A", rounded(result.current_rms_A, 4)},
                  {"verdict", to_string(result.verdict)},
                  {"data_quality", result.data_quality},
                  {"balance", balance_json(trace)},
                  {"stored_W", rounded(trace.stored_W, 6)}});
  return result.verdict == Verdict::pass ? ExitCode::done : ExitCode::limit_exceeded;
}

GuardUse guard_use(const std::string& name) { return static_cast<GuardUse>(std::ranges::find(kGuardUses, name) - std::begin(kGuardUses)); }

ExitCode run(const Options& options, Session& session) {
  if (options.duty.empty() != options.jerk_sweep) {
    throw Failure(ExitCode::bad_input, "expected one of --duty and --jerk-sweep (`heatsoak simulate --help` shows examples)");
  }
  if (options.motor.empty() == options.model.empty()) {
    throw Failure(ExitCode::bad_input, "expected one of --motor M and --model FILE");
  }
  NamedFiles named(session.folders());
  const std::optional<Robot> robot_read = named.robot(options.robot);
  const std::optional<Motor> motor_read = named.motor(options.model.empty() ? options.motor : options.model);
  const std::optional<Duty> duty_read = options.jerk_sweep ? std::nullopt : named.duty(options.duty);
  named.throw_if_any();
  const bool is_driven = options.jerk_sweep || std::dynamic_pointer_cast<const MatchDuty>(duty_read->shape_data) != nullptr;
  const Robot robot = is_driven ? with_assumed_friction(*robot_read) : *robot_read;
  const Motor motor = under(*motor_read, options.conditions);
  const auto needs_a_plant = [&motor] {
    if (std::isnan(motor.nominal.rotor_inertia_kg_m2)) {
      throw bad_input({motor.file.string()}, "figures.rotor_inertia",
                      "is missing: without it no acceleration of a wheel can be calculated");
    }
  };
  if (options.jerk_sweep) {
    needs_a_plant();
    if (!options.out.empty()) {
      throw Failure(ExitCode::bad_input, "--jerk-sweep has no signals to write; expected --plot or --json in place of --out");
    }
    const DriveOptions drive = options.sensing == "ideal" ? ideal_drive() : real_drive(robot, options.seed);
    return sweep_jerk(robot, motor, drive, options.plot, session);
  }
  const Duty& duty = *duty_read;
  const auto match = std::dynamic_pointer_cast<const MatchDuty>(duty.shape_data);
  if (!match) {
    return run_load(options, robot, motor, duty, session);
  }
  needs_a_plant();
  std::vector<Planner> planners;
  if (options.planner != "bang_bang") {
    planners.push_back(Planner::jerk_limited);
  }
  if (options.planner != "jerk_limited") {
    planners.push_back(Planner::bang_bang);
  }
  return simulate_match({robot, motor, duty, match->inputs(), planners, options.seed, options.out, options.plot, options.every_s,
                         guard_use(options.guard), options.sensing == "ideal"},
                        session);
}

}  // namespace

Command simulate() {
  return {.name = {},
          .summary = "One match in a closed loop, or one motor under a prescribed load: every signal over time, and where the energy goes",
          .example =
              "heatsoak simulate --motor maxon_ecx_flat_32l_48v --robot roboteam_twente_v2024 --duty division_a_match --out trace.csv "
              "--plot trace.svg\n"
              "  heatsoak simulate --motor maxon_ecx_flat_32l_48v --robot roboteam_twente_v2024 --duty division_a_match --planner both\n"
              "  heatsoak simulate --motor maxon_ecx_flat_32l_48v --robot roboteam_twente_v2024 --jerk-sweep --plot sweep.svg",
          .declare = [](CLI::App& app, Session& session) -> std::function<ExitCode()> {
            const auto options = std::make_shared<Options>();
            app.add_option("--motor", options->motor, "id (see `heatsoak list motors`) or file")->type_name("M");
            app.add_option("--model", options->model, "a calibrated motor (`heatsoak calibrate --out FILE`) in its place")
                ->type_name("FILE.toml");
            add_conditions(app, options->conditions);
            app.add_option("--robot", options->robot, "id (see `heatsoak list robots`) or file")->required()->type_name("R");
            app.add_option("--duty", options->duty, "id (see `heatsoak list duties`) or file; a match is driven in a closed loop")
                ->type_name("D");
            add_table(app, options->out,
                      "every signal; names end in units, a row's inputs hold until the next row; reasons are the drive core's codes "
                      "(robot_core/reason.h)");
            app.add_option("--planner", options->planner, "of a match; both: the two side by side")
                ->check(CLI::IsMember({"jerk_limited", "bang_bang", "both"}))
                ->type_name("P")
                ->capture_default_str();
            app.add_flag("--jerk-sweep", options->jerk_sweep,
                         "instead of a duty: short drives with several jerk limits, compared with bang-bang: slip, time, precision, heat");
            add_picture(app, options->plot, "picture of temperatures and heat sources");
            app.add_option("--guard", options->guard,
                           "of a match: the motor's thermal guard as `heatsoak derate` makes it. shadow: counts what it would limit and "
                           "limits nothing; on: limits the currents")
                ->check(CLI::IsMember({"off", "shadow", "on"}))
                ->type_name("G")
                ->capture_default_str();
            app.add_option("--sensing", options->sensing,
                           "of a match or jerk sweep: real has encoder steps, gyro drift, lost and late radio packets, noisy poses; "
                           "ideal has none of them")
                ->check(CLI::IsMember({"ideal", "real"}))
                ->type_name("S")
                ->capture_default_str();
            add_seed(app, options->seed, "of a generated match, sensors and radio; same seed, same bytes");
            add_quantity(app, "--every", options->every_s,
                         {"every", "s", Range::between(1e-3, 1e5), "longest time between two rows; 1 s unless given"});
            session.add_data_option(app);
            session.add_answer_options(app);
            return [options, &session] { return run(*options, session); };
          }};
}

}  // namespace heatsoak::commands
