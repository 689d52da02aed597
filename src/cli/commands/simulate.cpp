#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>

#include "cli/command.h"
#include "cli/condition_option.h"
#include "cli/quantity_option.h"
#include "duty/match/match_duty.h"
#include "duty/named_files.h"
#include "motor/conditions.h"
#include "present/jerk_sweep.h"
#include "present/jerk_sweep_chart.h"
#include "present/match.h"
#include "present/match_chart.h"
#include "present/verdict_chart.h"
#include "simulate/planner_study.h"

namespace heatsoak::cli::commands {
namespace {

struct SimulateOptions {
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

present::GivenInputs given(const SimulateOptions& options, const Session& session) {
  return {.robot = options.robot,
          .duty = options.duty,
          .motor = options.motor,
          .model = options.model,
          .database = session.database(),
          .conditions = options.conditions};
}

/// `make` returns the chart; it is called only if the chart is requested.
template <class Make>
void show(present::Document document, const SimulateOptions& options, Session& session, const Make& make) {
  if (session.draws(options.plot)) {
    session.draw(document, options.plot, make());
  }
  session.show(document);
}

/// Simulates a prescribed load of one wheel.
base::ExitCode run_load(const SimulateOptions& options, select::LoadJob job, Session& session) {
  if (options.planner != "jerk_limited") {
    throw base::Failure(base::ExitCode::bad_input, fmt::format("--planner is for matches; {} is {}", job.duty.id, job.duty.shape));
  }
  const SimulateOptions usual;
  if (options.guard != usual.guard || options.sensing != usual.sensing) {
    throw base::Failure(
        base::ExitCode::bad_input,
        fmt::format("--guard and --sensing are for matches, which the drive core drives; {} is {}", job.duty.id, job.duty.shape));
  }
  job.seed = options.seed;
  job.every_s = options.every_s;
  job.with_curves = session.draws(options.plot);
  session.begin_computation();
  const select::LoadSimulation simulation = select::simulate_load(job);
  if (!options.out.empty()) {
    session.write(options.out, select::to_csv(simulation.trace));
  }
  show(present::load_simulation_document(simulation, given(options, session)), options, session,
       [&] { return present::verdict_chart({simulation.result}, simulation.robot, simulation.duty); });
  return simulation.result.verdict == select::Verdict::pass ? base::ExitCode::done : base::ExitCode::limit_exceeded;
}

base::ExitCode run_match(const SimulateOptions& options, simulate::MatchJob job, Session& session) {
  job.planners.clear();
  if (options.planner != "bang_bang") {
    job.planners.push_back(duty::Planner::jerk_limited);
  }
  if (options.planner != "jerk_limited") {
    job.planners.push_back(duty::Planner::bang_bang);
  }
  job.seed = options.seed;
  job.guard = static_cast<simulate::GuardUse>(std::ranges::find(simulate::kGuardUses, options.guard) - std::begin(simulate::kGuardUses));
  job.is_sensing_ideal = options.sensing == "ideal";
  job.with_table = !options.out.empty();
  job.every_s = options.every_s;
  job.with_rows = session.draws(options.plot);
  simulate::MatchSimulation match =
      with_progress(session, [&](const base::JobProgress& progress) { return simulate::simulate_match(job, progress); });
  if (job.with_table) {
    session.write(options.out, std::move(match.runs.front().csv));
  }
  show(present::match_document(match, given(options, session)), options, session, [&] { return present::match_chart(match); });
  return match.verdict() == select::Verdict::pass ? base::ExitCode::done : base::ExitCode::limit_exceeded;
}

base::ExitCode run_sweep(const SimulateOptions& options, const robot::Robot& robot, const motor::Motor& motor, Session& session) {
  if (!options.out.empty()) {
    throw base::Failure(base::ExitCode::bad_input, "--jerk-sweep has no signals to write; expected --plot or --json in place of --out");
  }
  const simulate::JerkSweep sweep = with_progress(session, "driving", 10.0, [&](const base::Progress& progress) {
    return simulate::sweep_jerk(robot, motor, options.sensing == "ideal", options.seed, progress);
  });
  show(present::jerk_sweep_document(sweep), options, session, [&] { return present::jerk_sweep_chart(sweep); });
  return base::ExitCode::done;
}

base::ExitCode run(const SimulateOptions& options, Session& session) {
  if (options.duty.empty() != options.jerk_sweep) {
    throw base::Failure(base::ExitCode::bad_input, "expected one of --duty and --jerk-sweep (`heatsoak simulate --help` shows examples)");
  }
  if (options.motor.empty() == options.model.empty()) {
    throw base::Failure(base::ExitCode::bad_input, "expected one of --motor M and --model FILE");
  }
  duty::NamedFiles named(session.folders());
  const std::optional<robot::Robot> robot = named.robot(options.robot);
  const std::optional<motor::Motor> as_named = named.motor(options.model.empty() ? options.motor : options.model);
  const std::optional<duty::Duty> duty = options.jerk_sweep ? std::nullopt : named.duty(options.duty);
  named.throw_if_any();
  const motor::Motor motor = motor::under(*as_named, options.conditions);
  if (!duty) {
    return run_sweep(options, *robot, motor, session);
  }
  return duty::is_match(*duty) ? run_match(options, {.robot = *robot, .motor = motor, .duty = *duty}, session)
                               : run_load(options, {.robot = *robot, .motor = motor, .duty = *duty}, session);
}

}  // namespace

Command simulate() {
  return {.name = {},
          .summary =
              "Simulates one match in a closed loop, or one motor under a prescribed load: every signal over time, and the energy balance",
          .example =
              "heatsoak simulate --motor maxon_ecx_flat_32l_48v --robot roboteam_twente_v2024 --duty division_a_match --out trace.csv "
              "--plot trace.svg\n"
              "  heatsoak simulate --motor maxon_ecx_flat_32l_48v --robot roboteam_twente_v2024 --duty division_a_match --planner both\n"
              "  heatsoak simulate --motor maxon_ecx_flat_32l_48v --robot roboteam_twente_v2024 --jerk-sweep --plot sweep.svg",
          .declare = [](CLI::App& app, Session& session) -> std::function<base::ExitCode()> {
            const auto options = std::make_shared<SimulateOptions>();
            app.add_option("--motor", options->motor, "id (see `heatsoak list motors`) or file")->type_name("M");
            app.add_option(
                   "--model", options->model,
                   "calibrated motor (`heatsoak calibrate --out FILE`), in place of --motor. If the file has a forecast band, a second "
                   "run uses the losses at their 95th percentile; the verdict is marginal (exit 1) if only that run exceeds a limit "
                   "or misses the demand")
                ->type_name("FILE.toml");
            add_conditions(app, options->conditions);
            app.add_option("--robot", options->robot, "id (see `heatsoak list robots`) or file")->required()->type_name("R");
            app.add_option("--duty", options->duty, "id (see `heatsoak list duties`) or file; a match is driven in a closed loop")
                ->type_name("D");
            add_table(app, options->out,
                      "table of every signal; names end in units, a row's inputs hold until the next row; reasons are the drive core's "
                      "codes (robot_core/reason.h)");
            app.add_option("--planner", options->planner, "planner of a match; both: the two side by side")
                ->check(CLI::IsMember({"jerk_limited", "bang_bang", "both"}))
                ->type_name("P")
                ->capture_default_str();
            app.add_flag("--jerk-sweep", options->jerk_sweep,
                         "run short drives instead of a duty, with several jerk limits and bang-bang; compare slip, time, precision, heat");
            add_picture(app, options->plot, "picture of temperatures and heat sources");
            app.add_option("--guard", options->guard,
                           "thermal guard of the motor in a match, as `heatsoak derate` makes it; shadow: counts what it would limit and "
                           "limits nothing; on: limits the currents")
                ->check(CLI::IsMember({"off", "shadow", "on"}))
                ->type_name("G")
                ->capture_default_str();
            app.add_option("--sensing", options->sensing,
                           "sensing in a match or jerk sweep; real: encoder steps, gyro drift, lost and late radio packets, noisy poses; "
                           "ideal: none of them")
                ->check(CLI::IsMember({"ideal", "real"}))
                ->type_name("S")
                ->capture_default_str();
            add_seed(app, options->seed, "seed of a generated match, of sensors and radio; the same seed gives the same bytes");
            add_quantity(app, "--every", options->every_s,
                         {"every", "s", base::Range::between(1e-3, 1e5), "longest time between two rows; 1 s unless given"});
            session.add_data_option(app);
            session.add_answer_options(app);
            return [options, &session] { return run(*options, session); };
          }};
}

}  // namespace heatsoak::cli::commands
