#include "present/measured/friction.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <memory>
#include <optional>

#include "cli/command.h"
#include "cli/quantity_option.h"
#include "duty/named_files.h"
#include "friction/friction_job.h"
#include "present/failure_words.h"
#include "present/measured/friction_chart.h"

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

friction::FrictionJob job_of(const FrictionOptions& options, const input::DataFolders& folders) {
  friction::FrictionJob job{
      .robot = duty::robot_named(folders, options.robot), .logs = options.logs, .folders = folders, .map = options.map};
  job.motor_id = options.motor.empty() ? job.robot.drive.motor : options.motor;
  const std::optional<motor::Motor> motor =
      options.motor.empty() ? duty::own_motor(folders, job.robot) : duty::motor_named(folders, options.motor);
  if (motor) {
    job.motor = motor->nominal;
  }
  job.method = options.method == "roll_out" ? friction::FrictionMethod::roll_out : friction::FrictionMethod::steady_state;
  job.direction = options.direction == "commanded"  ? friction::TravelDirection::commanded
                  : options.direction == "measured" ? friction::TravelDirection::measured
                  : options.direction == "wheels"   ? friction::TravelDirection::wheels
                                                    : friction::TravelDirection::best;
  job.use_return_legs = options.return_legs == "use";
  job.is_lifted = options.is_lifted;
  job.takes_logs_as_they_are = options.takes_logs_as_they_are;
  job.writes_robot_file = !options.out.empty();
  return job;
}

/// Returns the name of the second picture: "x_voltage.svg" beside "x.svg"; empty without a first one.
std::string second_picture(const std::filesystem::path& first) {
  return first.empty()
             ? ""
             : std::filesystem::path(first).replace_filename(first.stem().string() + "_voltage" + first.extension().string()).string();
}

base::ExitCode run(const FrictionOptions& options, Session& session) {
  if (options.method == "roll_out" && !options.plot.empty()) {
    throw base::Failure(base::ExitCode::bad_input, "--plot draws the steady-state test; a roll-out has no picture");
  }
  if (options.method != "roll_out" && options.is_lifted) {
    throw base::Failure(base::ExitCode::bad_input, "--lifted applies to roll-outs only; expected --method roll_out with it");
  }
  const friction::FrictionJob job = job_of(options, session.folders());
  session.require_readable(options.logs);
  const friction::FrictionAnswer answer =
      with_progress(session, "reading", 2.0, [&](const base::Progress& progress) { return friction::run_friction(job, progress); });
  present::Document document = present::friction_document(job, answer);
  if (!options.out.empty()) {
    session.write(options.out, friction::robot_text(answer));
  }
  if (session.draws(options.plot)) {
    std::string file = options.plot;
    for (report::Chart& chart : present::friction_charts(job, answer)) {
      session.draw(document, file, std::move(chart));
      file = second_picture(options.plot);
    }
  }
  session.show(document);
  return base::ExitCode::done;
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
