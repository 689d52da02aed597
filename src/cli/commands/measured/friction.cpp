#include "present/measured/friction.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/quantity_option.h"
#include "duty/named_files.h"
#include "friction/friction_job.h"
#include "present/measured/failure_words.h"
#include "present/measured/friction_chart.h"
#include "present/measured/friction_words.h"
#include "present/robot_notes.h"

namespace heatsoak::cli::commands {
namespace {

struct FrictionOptions {
  std::string robot;
  std::string motor;
  std::vector<std::string> logs;
  std::string map;
  std::string method = "steady_state";
  std::string direction = "best";
  std::string return_legs = "leave_out";
  bool is_lifted = false;
  bool takes_logs_as_they_are = false;
  std::string out;
  std::string plot;
};

struct Input {
  friction::FrictionJob job;
  std::string motor_id;
};

/// Finds the motor. The robot's own motor may be missing from the data base: fits from modulation do not need it, and
/// present::friction_remarks() reports it.
void find_motor(const FrictionOptions& options, const input::DataFolders& folders, Input& input) {
  input.motor_id = options.motor.empty() ? input.job.robot.drive.motor : options.motor;
  try {
    input.job.motor = duty::motor_named(folders, input.motor_id).nominal;
  } catch (const base::Failure&) {
    if (!options.motor.empty()) {
      throw;
    }
  }
}

Input input_of(const FrictionOptions& options, const Session& session) {
  const input::DataFolders folders = session.folders();
  Input input{.job = {.robot = duty::robot_named(folders, options.robot), .logs = options.logs, .folders = folders, .map = options.map},
              .motor_id = {}};
  find_motor(options, folders, input);
  friction::FrictionJob& job = input.job;
  job.direction = options.direction == "commanded"  ? friction::TravelDirection::commanded
                  : options.direction == "measured" ? friction::TravelDirection::measured
                  : options.direction == "wheels"   ? friction::TravelDirection::wheels
                                                    : friction::TravelDirection::best;
  job.use_return_legs = options.return_legs == "use";
  job.is_lifted = options.is_lifted;
  job.takes_logs_as_they_are = options.takes_logs_as_they_are;
  job.writes_robot_file = !options.out.empty();
  return input;
}

void draw(const FrictionOptions& options, const robot::Robot& robot, const friction::SteadyFriction& found, present::Document& document,
          Session& session) {
  const friction::FrictionFit& fit = found.fit;
  const std::string of_headings = fmt::format("{} legs on {} headings", found.steady.parts.size(), fit.headings);
  report::Chart chart = present::friction_chart(fit, robot.name, of_headings);
  std::string second = options.plot;
  if (!chart.panels.empty()) {
    session.draw(document, options.plot, std::move(chart));
    const std::filesystem::path first = options.plot;
    second = first.empty()
                 ? ""
                 : std::filesystem::path(first).replace_filename(first.stem().string() + "_voltage" + first.extension().string()).string();
  }
  session.draw(document, second, present::voltage_chart(found.steady, fit, robot::make_kinematics(robot), robot.name, found.settings));
}

void write_robot_file(const FrictionOptions& options, const friction::FrictionRun& run, present::Document& document, Session& session) {
  if (!options.out.empty()) {
    session.write(options.out, run.robot_text);
    for (const friction::WrittenAsZero& each : run.notes) {
      document.add_note(present::Severity::note, present::words_of(each));
    }
    document.add_file(options.out);
  }
}

base::ExitCode steady_state(const FrictionOptions& options, const Input& input, Session& session) {
  const robot::Robot& robot = input.job.robot;
  const friction::SteadyFriction found =
      with_progress("reading", 2.0, [&](const base::Progress& progress) { return friction::steady_friction(input.job, progress); });
  const present::FrictionRemarks remarks =
      present::friction_remarks(input.motor_id, input.job.motor.has_value(), found, present::lack_of_fit_words(found.fit));
  const present::FrictionAnswer answer{found.steady,        found.fit,          found.error, found.settings.use_return_legs,
                                       found.expected_from, options.logs.size()};
  present::Document document = present::friction_document(robot, answer);
  present::add_findings(document, remarks.findings, remarks.suspicions);
  present::add_robot_notes(document, robot);
  write_robot_file(options, found, document, session);
  if (session.draws(options.plot)) {
    draw(options, robot, found, document, session);
  }
  session.show(document);
  session.answer(present::friction_json(robot, answer, remarks));
  return base::ExitCode::done;
}

base::ExitCode by_roll_out(const FrictionOptions& options, const Input& input, Session& session) {
  const friction::RollOutFriction found =
      with_progress("reading", 2.0, [&](const base::Progress& progress) { return friction::roll_out_friction(input.job, progress); });
  const present::FrictionRemarks remarks = present::friction_remarks(input.motor_id, input.job.motor.has_value(), found, {});
  present::Document document = present::roll_out_document(input.job.robot, found.result, found.drive, options.logs.size());
  present::add_findings(document, remarks.findings, remarks.suspicions);
  present::add_robot_notes(document, input.job.robot);
  write_robot_file(options, found, document, session);
  session.show(document);
  session.answer(present::roll_out_json(input.job.robot, found.result, found.drive, remarks));
  return base::ExitCode::done;
}

base::ExitCode run(const FrictionOptions& options, Session& session) {
  if (options.method == "roll_out" && !options.plot.empty()) {
    throw base::Failure(base::ExitCode::bad_input, "--plot draws the steady-state test; a roll-out has no picture");
  }
  if (options.method != "roll_out" && options.is_lifted) {
    throw base::Failure(base::ExitCode::bad_input, "--lifted applies to roll-outs only; expected --method roll_out with it");
  }
  const Input input = input_of(options, session);
  return options.method == "steady_state" ? steady_state(options, input, session) : by_roll_out(options, input, session);
}

}  // namespace

Command friction() {
  return {.name = {},
          .summary =
              "Determines damping and friction of every wheel over the direction of travel, from logs of a steady-state test; exit 3 if "
              "nothing is identifiable",
          .example =
              "heatsoak friction --robot roboteam_twente_v2024 reports/friction_test/steady_state_test.csv --out my_robot.toml "
              "--plot friction.svg",
          .declare = [](CLI::App& app, Session& session) -> std::function<base::ExitCode()> {
            const auto options = std::make_shared<FrictionOptions>();
            app.add_option("logs", options->logs,
                           "logs of the drives: wheel_speed_rad_per_s_1 …, wheel_modulation_ratio_1 … with battery_V (or "
                           "wheel_current_A_1 …), heading_rad or another signal of the direction")
                ->required()
                ->type_name("LOG");
            app.add_option("--robot", options->robot, "id (see `heatsoak list robots`) or file")->required()->type_name("R");
            app.add_option("--motor", options->motor, "motor in the robot during the test; the robot's own unless given")->type_name("M");
            app.add_option("--map", options->map, "mapping of foreign logs (see `heatsoak log --help`)")->type_name("FILE.toml");
            app.add_option("--method", options->method, "method of the test; roll_out: damping alone, from decelerations with open motors")
                ->check(CLI::IsMember({"steady_state", "roll_out"}))
                ->capture_default_str();
            app.add_option("--direction", options->direction, "source of the direction of travel; best: the first that the logs have")
                ->check(CLI::IsMember({"best", "commanded", "measured", "wheels"}))
                ->capture_default_str();
            app.add_option("--return-legs", options->return_legs, "treatment of the legs that bring the robot back")
                ->check(CLI::IsMember({"leave_out", "use"}))
                ->capture_default_str();
            app.add_flag("--as-is", options->takes_logs_as_they_are, "continue although units, signs or the order of wheels look wrong");
            app.add_flag("--lifted", options->is_lifted,
                         "take the wheels as off the ground, with --method roll_out; the speed of one wheel is enough then");
            app.add_option("--out", options->out, "robot file that contains the friction found")->type_name("ROBOT.toml");
            add_picture(app, options->plot,
                        "picture of offset and damping over the headings; voltage over speed is beside it, in FILE_voltage.svg");
            session.add_data_option(app);
            session.add_answer_options(app);
            return [options, &session] { return present::with_words([&] { return run(*options, session); }); };
          }};
}

}  // namespace heatsoak::cli::commands
