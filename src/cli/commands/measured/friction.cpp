#include "present/measured/friction.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <array>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/quantity.h"
#include "cli/command.h"
#include "cli/quantity_option.h"
#include "duty/named_files.h"
#include "friction/expected_voltage.h"
#include "friction/friction_suspicions.h"
#include "friction/read_friction_log.h"
#include "friction/robot_file.h"
#include "friction/roll_out.h"
#include "present/measured/friction_chart.h"
#include "recording/quality.h"
#include "recording/read_recording.h"

namespace heatsoak::commands {
namespace {

struct Options {
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

/// Input of both methods.
struct Input {
  Robot robot;
  std::optional<MotorValues> motor;
  std::string motor_id;
  std::vector<FrictionLog> logs;
  Findings findings;
  std::vector<std::string> suspicions;
  std::vector<Diagnostic> blocking;  ///< the suspicions (units, signs, wheel order) that would make the answer wrong if true
};

/// Finds the motor. The robot's own motor may be missing from the data base: fits from modulation do not need it.
void find_motor(const Options& options, const DataFolders& folders, Input& input) {
  input.motor_id = options.motor.empty() ? input.robot.drive.motor : options.motor;
  try {
    input.motor = motor_named(folders, input.motor_id).nominal;
  } catch (const Failure&) {
    if (!options.motor.empty()) {
      throw;
    }
    input.findings.push_back(fmt::format("there is no file of the robot's motor '{}'; name a motor with --motor", input.motor_id));
  }
}

/// Throws if a log is given twice, because it would make the intervals too narrow. `seen` holds files and the hash of their content.
void refuse_repeated(const Recording& recording, std::vector<std::pair<std::filesystem::path, std::size_t>>& seen) {
  std::size_t held = recording.rows();
  const auto add = [&held](double value) { held = held * 1'000'003 + std::hash<double>{}(value); };
  std::ranges::for_each(recording.time_s, add);
  for (const Channel& channel : recording.channels) {
    std::ranges::for_each(channel.values, add);
  }
  if (const auto found = std::ranges::find(seen, held, &std::pair<std::filesystem::path, std::size_t>::second); found != seen.end()) {
    throw Failure(ExitCode::bad_input, "a log is given twice",
                  {{{recording.file.string()}, {}, fmt::format("holds the same rows as {}", found->first.string())}});
  }
  seen.emplace_back(recording.file, held);
}

/// Values from a wrong unit would get into the robot's file and from there into its firmware.
void refuse_what_looks_wrong(const Options& options, const Input& input) {
  if (!input.blocking.empty() && !options.takes_logs_as_they_are) {
    throw Failure(ExitCode::bad_input,
                  "units, signs or wheels of the logs look wrong; correct them in a mapping (--map) or in the robot's file, or use --as-is "
                  "if they are right",
                  input.blocking);
  }
}

Input read_input(const Options& options, const Session& session) {
  const DataFolders folders = session.folders();
  Input input{.robot = robot_named(folders, options.robot),
              .motor = {},
              .motor_id = {},
              .logs = {},
              .findings = {},
              .suspicions = {},
              .blocking = {}};
  find_motor(options, folders, input);
  FrictionLogNeeds needs;
  needs.voltage = options.method == "steady_state";
  if (input.motor) {
    needs.drive = drive_constants(input.robot, *input.motor);
  }
  needs.direction = options.direction == "commanded"  ? TravelDirection::commanded
                    : options.direction == "measured" ? TravelDirection::measured
                    : options.direction == "wheels"   ? TravelDirection::wheels
                                                      : TravelDirection::best;
  const Progress progress = progress_bar("reading");
  std::vector<std::pair<std::filesystem::path, std::size_t>> seen;
  for (std::size_t i = 0; i < options.logs.size(); ++i) {
    RecordingReport report;
    const std::filesystem::path file = log_named(folders, options.logs[i]);
    const Recording recording = read_recording(file, mapping_for(file, options.map), report);
    input.logs.push_back(friction_log(recording, input.robot, needs, input.findings));
    const DataQuality quality = assess(recording, report);
    for (const std::string& suspicion : quality.suspicions) {
      input.suspicions.push_back(fmt::format("{}: {}", recording.name, suspicion));
    }
    for (const std::string& suspicion : quality.blocking_for_wheels) {
      input.blocking.push_back({{recording.file.string()}, {}, suspicion});
    }
    refuse_repeated(recording, seen);
    if (progress) {
      progress(i + 1, options.logs.size());
    }
  }
  return input;
}

std::string source_of(const Options& options) {
  const std::string first = std::filesystem::path(options.logs.front()).filename().string();
  return options.logs.size() == 1 ? fmt::format("friction test, {}", first)
                                  : fmt::format("friction test, {} and {} more logs", first, options.logs.size() - 1);
}

/// Explains why nothing was learned, with the problem of wheel 1 as the example.
Failure nothing_learned(const SteadyParts& steady, const FrictionFit& fit, const std::vector<std::string>& suspicions) {
  const std::string suspected = suspicions.empty() ? "" : fmt::format("\nsuspicious: {}", fmt::join(suspicions, "\nsuspicious: "));
  if (steady.parts.empty()) {
    return {
        ExitCode::cannot_answer,
        "nothing is identifiable: in no interval do the wheels turn steadily; legs of one speed and direction must last a second or more" +
            suspected};
  }
  return {ExitCode::cannot_answer,
          fmt::format("nothing is identifiable from {} on {}: of wheel 1, {}{}", counted(steady.parts.size(), "steady leg"),
                      counted(static_cast<std::size_t>(fit.headings), "heading"), fit.wheels.front().problem, suspected)};
}

void draw(const Options& options, const Input& input, const SteadyParts& steady, const FrictionFit& fit, const FitSettings& settings,
          present::Document& document, Session& session) {
  const std::string of_headings = fmt::format("{} legs on {} headings", steady.parts.size(), fit.headings);
  std::filesystem::path voltage = options.plot;
  voltage.replace_filename(voltage.stem().string() + "_voltage" + voltage.extension().string());
  const Chart chart = present::friction_chart(fit, input.robot.name, of_headings);
  if (!chart.panels.empty()) {
    session.write(options.plot, draw_picture(chart, options.plot));
    document.add_file(options.plot);
  }
  const std::string second = chart.panels.empty() ? options.plot : voltage.string();
  session.write(second,
                draw_picture(present::voltage_chart(steady, fit, make_kinematics(input.robot), input.robot.name, settings), second));
  document.add_file(second);
}

present::FrictionRemarks remarks_of(const Input& input) {
  return {input.motor ? std::optional(input.motor_id) : std::nullopt, input.findings, input.suspicions};
}

ExitCode steady_state(const Options& options, Input& input, Session& session) {
  const Kinematics kinematics = make_kinematics(input.robot);
  const SteadyParts steady = find_steady_parts(input.logs, kinematics);
  FitSettings settings;
  settings.use_return_legs = options.return_legs == "use";
  Expectation before;
  if (input.motor) {
    before = expectation(input.robot, *input.motor);
    settings.known_damping_V_s_per_rad = before.damping_V_s_per_rad;
  }
  const FrictionFit fit = fit_friction(steady.parts, kinematics, settings);
  for (const std::string& suspicion : friction_suspicions(
           steady, fit, kinematics, input.motor ? std::optional(drive_constants(input.robot, *input.motor)) : std::nullopt)) {
    input.suspicions.push_back(suspicion);
    input.blocking.push_back({{options.logs.front()}, {}, suspicion});
  }
  refuse_what_looks_wrong(options, input);
  if (!fit.is_learned()) {
    throw nothing_learned(steady, fit, input.suspicions);
  }
  std::ranges::move(present::lack_of_fit_words(fit), std::back_inserter(input.findings));
  const HeldOutError error = error_on_held_out_headings(steady.parts, kinematics, settings, before.voltages);
  const present::FrictionAnswer answer{
      steady, fit, error, settings.use_return_legs, static_cast<bool>(before.voltages), before.from, input.logs.size()};
  present::Document document = present::friction_document(input.robot, answer);
  present::add_findings(document, input.findings, input.suspicions);
  if (!options.out.empty()) {
    if (!input.motor) {
      throw Failure(ExitCode::bad_input, "--out: a robot's file has torques; --motor must name the motor that converts volts to torques");
    }
    Findings notes;
    session.write(options.out, with_measured_friction(read_file(input.robot.file, 1'000'000), input.robot,
                                                      drive_constants(input.robot, *input.motor), fit, source_of(options), notes));
    present::add_findings(document, notes, {});
    document.add_file(options.out);
  }
  if (!options.plot.empty()) {
    draw(options, input, steady, fit, settings, document, session);
  }
  session.show(document);
  session.answer(present::friction_json(input.robot, answer, remarks_of(input)));
  return ExitCode::done;
}

ExitCode by_roll_out(const Options& options, Input& input, Session& session) {
  if (!input.motor) {
    throw Failure(ExitCode::bad_input, "a roll-out needs the inertia of the motor's rotor; --motor must name the motor");
  }
  refuse_what_looks_wrong(options, input);
  const RollOutResult result = roll_out(input.logs, input.robot, *input.motor, options.is_lifted);
  if (result.runs.empty()) {
    throw Failure(ExitCode::cannot_answer,
                  "nothing is identifiable: in no interval of 15 rows do the wheels roll out with their drivers off");
  }
  DriveConstants drive = drive_constants(input.robot, *input.motor);
  drive.drag_torque_Nm = 0.0;
  present::Document document = present::roll_out_document(input.robot, result, drive, input.logs.size());
  present::add_findings(document, input.findings, input.suspicions);
  if (!options.out.empty()) {
    session.write(options.out, with_measured_damping(read_file(input.robot.file, 1'000'000), input.robot, result.wheel_damping_Nm_s_per_rad,
                                                     source_of(options)));
    document.add_file(options.out);
  }
  session.show(document);
  session.answer(present::roll_out_json(input.robot, result, drive, remarks_of(input)));
  return ExitCode::done;
}

ExitCode run(const Options& options, Session& session) {
  if (options.method == "roll_out" && !options.plot.empty()) {
    throw Failure(ExitCode::bad_input, "--plot draws the steady-state test; a roll-out has no picture");
  }
  if (options.method != "roll_out" && options.is_lifted) {
    throw Failure(ExitCode::bad_input, "--lifted applies to roll-outs only; expected --method roll_out with it");
  }
  Input input = read_input(options, session);
  return options.method == "steady_state" ? steady_state(options, input, session) : by_roll_out(options, input, session);
}

}  // namespace

Command friction() {
  return {.name = {},
          .summary =
              "Damping and friction of every wheel over the direction of travel, from logs of a steady-state test; exit 3 if nothing is "
              "identifiable",
          .example =
              "heatsoak friction --robot roboteam_twente_v2024 reports/friction_test/steady_state_test.csv --out my_robot.toml "
              "--plot friction.svg",
          .declare = [](CLI::App& app, Session& session) -> std::function<ExitCode()> {
            const auto options = std::make_shared<Options>();
            app.add_option("logs", options->logs,
                           "logs of the drives: wheel_speed_rad_per_s_1 …, wheel_pwm_ratio_1 … with battery_V (or "
                           "wheel_current_A_1 …), heading_rad or another signal of the direction")
                ->required()
                ->type_name("LOG");
            app.add_option("--robot", options->robot, "id (see `heatsoak list robots`) or file")->required()->type_name("R");
            app.add_option("--motor", options->motor, "that the robot drove with; the robot's own unless given")->type_name("M");
            app.add_option("--map", options->map, "mapping of foreign logs (see `heatsoak log --help`)")->type_name("FILE.toml");
            app.add_option("--method", options->method, "steady_state, or roll_out: damping alone, from decelerations with open motors")
                ->check(CLI::IsMember({"steady_state", "roll_out"}))
                ->capture_default_str();
            app.add_option("--direction", options->direction, "source of the direction of travel; best: the first that the logs have")
                ->check(CLI::IsMember({"best", "commanded", "measured", "wheels"}))
                ->capture_default_str();
            app.add_option("--return-legs", options->return_legs, "legs that bring the robot back")
                ->check(CLI::IsMember({"leave_out", "use"}))
                ->capture_default_str();
            app.add_flag("--as-is", options->takes_logs_as_they_are, "continue although units, signs or the order of wheels look wrong");
            app.add_flag("--lifted", options->is_lifted, "roll_out: the wheels were off the ground");
            app.add_option("--out", options->out, "the robot's file with the friction found in it")->type_name("ROBOT.toml");
            add_picture(app, options->plot, "offset and damping over the headings; voltage over speed goes beside it, FILE_voltage.svg");
            session.add_data_option(app);
            session.add_answer_options(app);
            return [options, &session] { return run(*options, session); };
          }};
}

}  // namespace heatsoak::commands
