#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/command.h"
#include "cli/condition_option.h"
#include "cli/quantity_option.h"
#include "duty/named_files.h"
#include "present/evaluation.h"
#include "select/candidates.h"
#include "select/decision.h"
#include "simulate/evaluation.h"

namespace heatsoak::cli::commands {
namespace {

/// Values of --fail-on. Exit code 1 from the given one on.
const std::vector<std::pair<std::string, select::Verdict>> kFailOn{
    {"marginal", select::Verdict::marginal}, {"fail", select::Verdict::fail}, {"infeasible", select::Verdict::infeasible}};

struct EvaluateOptions {
  std::string robot;
  std::string duty;
  std::optional<std::string> motors;
  std::string model;
  std::string plot;
  std::map<std::string, std::string> conditions;
  simulate::EvaluationJob job;  ///< its files are read by run()
  bool is_closed_loop = false;
  simulate::ClosedLoopJob closed_loop;
  std::string guard = "shadow";
  std::string fail_on = "fail";
};

/// An existing file whose name contains commas is one motor, not a list. A model without --motors is evaluated alone.
std::vector<std::string> listed_motors(const EvaluateOptions& options) {
  if (!options.motors) {
    return options.model.empty() ? std::vector<std::string>{"all"} : std::vector<std::string>{};
  }
  std::error_code unreadable;
  if (options.motors->find(',') == std::string::npos || std::filesystem::exists(*options.motors, unreadable)) {
    return {*options.motors};
  }
  std::vector<std::string> names = CLI::detail::split(*options.motors, ',');
  std::ranges::for_each(names, [](std::string& name) { CLI::detail::trim(name); });
  if (options.motors->ends_with(',') || std::ranges::any_of(names, &std::string::empty)) {
    throw base::Failure(base::ExitCode::bad_input,
                        fmt::format("--motors {}: a name is missing before or after a comma; expected one motor or several, "
                                    "such as a,b, or all",
                                    *options.motors));
  }
  return names;
}

simulate::EvaluationJob job_of(const EvaluateOptions& options, const Session& session) {
  const input::DataFolders folders = session.folders();
  if (!options.is_closed_loop && options.guard != EvaluateOptions{}.guard) {
    throw base::Failure(base::ExitCode::bad_input, "--guard is for --closed-loop; expected both or none");
  }
  duty::NamedFiles named(folders);
  const std::optional<robot::Robot> robot = named.robot(options.robot);
  const std::optional<duty::Duty> duty = named.duty(options.duty);
  simulate::EvaluationJob job = options.job;
  std::vector<std::string> motors = listed_motors(options);
  if (!options.motors && options.model.empty() && robot && robot->drive.motor_file) {
    motors.push_back(robot->drive.motor_name());  // the data base lacks it
  }
  job.motors = select::named_candidates({std::move(motors), options.model, options.conditions}, named);
  named.throw_if_any();
  if (job.motors.empty()) {
    throw base::Failure(base::ExitCode::bad_input, fmt::format("there is no motor file in {}", folders.motors.string()));
  }
  job.robot = *robot;
  job.duty = *duty;
  job.conditions = options.conditions;
  job.database = [folders, conditions = options.conditions] { return select::motors_of_database(folders, conditions); };
  job.has_chosen_motors = !options.model.empty() || (options.motors && *options.motors != "all");
  job.with_bands = session.draws(options.plot);
  job.with_changes_if_passing = !session.shows_only_headline();
  if (options.is_closed_loop) {
    job.closed_loop = options.closed_loop;
    job.closed_loop->guard = options.guard == "off" ? simulate::GuardUse::off : simulate::GuardUse::shadow;
  }
  return job;
}

base::ExitCode run(const EvaluateOptions& options, Session& session) {
  const simulate::EvaluationJob job = job_of(options, session);
  const simulate::EvaluationAnswer answer =
      with_progress(session, [&](const base::JobProgress& progress) { return simulate::run_evaluation(job, progress); });
  present::Document document = present::evaluation_document(answer);
  if (session.draws(options.plot)) {
    session.draw(document, options.plot, present::evaluation_chart(answer));
  }
  session.show(document);
  return answer.worst_verdict() >= std::ranges::find(kFailOn, options.fail_on, &std::pair<std::string, select::Verdict>::first)->second
             ? base::ExitCode::limit_exceeded
             : base::ExitCode::done;
}

}  // namespace

Command evaluate_command() {
  return {
      .name = {},
      .summary =
          "Ranks motors on one duty of one robot: peak temperatures with uncertainty, and the limit that each motor reaches first; exit 1 "
          "if a motor fails",
      .example =
          "heatsoak evaluate --robot roboteam_twente_v2024 --duty division_a_match --motors "
          "maxon_ecx_flat_42m_24v,nanotec_df45l024048_a2 --plot verdict.svg",
      .declare = [](CLI::App& app, Session& session) -> std::function<base::ExitCode()> {
        const auto options = std::make_shared<EvaluateOptions>();
        app.add_option("--robot", options->robot, "id (see `heatsoak list robots`) or file")->required()->type_name("R");
        app.add_option("--duty", options->duty, "id (see `heatsoak list duties`) or file")->required()->type_name("D");
        app.add_option("--motor,--motors", options->motors, "ids or files separated by commas, or all")
            ->type_name("M,M")
            ->default_str("all");
        app.add_option("--model", options->model,
                       "calibrated motor (`heatsoak calibrate --out FILE`), in place of the motor that it was fitted from")
            ->type_name("FILE.toml");
        add_conditions(app, options->conditions);
        app.add_option(
               "--samples", options->job.samples,
               fmt::format("number of draws of every declared tolerance and range; a match has one game for every eight; 0: none, "
                           "so no verdict over tolerances; unless given, as many as decide the verdicts, at most {}, or {} on a match",
                           select::most_samples(false), select::most_samples(true)))
            ->check(whole_number(1'000'000))
            ->type_name("N");
        app.add_flag("--closed-loop", options->is_closed_loop,
                     "play games of a match in a closed loop: the drive core drives each motor, with slip, battery sag and real sensing; "
                     "ranking and exit 1 follow these games");
        app.add_option("--guard", options->guard,
                       "thermal guard with --closed-loop; shadow: counts for how long it would have limited the motor; off: leaves it out, "
                       "which saves some seconds per motor")
            ->check(CLI::IsMember({"off", "shadow"}))
            ->type_name("G")
            ->capture_default_str();
        app.add_option("--games", options->closed_loop.games, "number of games with --closed-loop, with successive seeds")
            ->check(CLI::Range(1, 1000).description("N (1 to 1000)"))
            ->capture_default_str();
        app.add_flag("!--no-changes", options->job.with_changes,
                     "do not search for the changes of the robot that cool its motor most: acceleration, jerk, speed, mass, wheels, gear");
        app.add_option("--fail-on", options->fail_on,
                       "exit 1 if a motor's verdict is this or worse; while it is undecided, the worst that it may become counts")
            ->check(CLI::IsMember(kFailOn))
            ->type_name("VERDICT")
            ->capture_default_str();
        add_seed(app, options->job.seed, "seed of the draws and games; the same seed gives the same bytes");
        app.add_option("--threads", options->job.threads, "number of threads, 0 for all cores; the result does not depend on it")
            ->check(whole_number(1024))
            ->capture_default_str();
        add_picture(app, options->plot, "picture of stator and winding temperature over time");
        session.add_data_option(app);
        session.add_answer_options(app);
        return [options, &session] { return run(*options, session); };
      }};
}

}  // namespace heatsoak::cli::commands
