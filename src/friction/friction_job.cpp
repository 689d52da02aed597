#include "friction/friction_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>
#include <utility>

#include "base/collected_failures.h"
#include "base/files.h"
#include "friction/expected_voltage.h"
#include "friction/friction_suspicions.h"
#include "friction/robot_file.h"
#include "recording/quality.h"
#include "recording/read_recording.h"

namespace heatsoak::friction {
namespace {

constexpr std::size_t kLargestRobotFile_bytes = 1'000'000;

using Rows = recording::RowsGivenTwice::Rows;

/// Adds a log that is given twice to `repeated`, because it would make the intervals too narrow. `seen` holds each log's rows and the
/// hash of their content.
void note_if_repeated(const recording::Recording& recording, std::vector<std::pair<Rows, std::size_t>>& seen,
                      std::vector<recording::RowsGivenTwice::Pair>& repeated) {
  std::size_t held = recording.rows();
  const auto add = [&held](double value) { held = held * 1'000'003 + std::hash<double>{}(value); };
  std::ranges::for_each(recording.time_s, add);
  for (const recording::Channel& channel : recording.channels) {
    std::ranges::for_each(channel.values, add);
  }
  if (const auto found = std::ranges::find(seen, held, &std::pair<Rows, std::size_t>::second); found != seen.end()) {
    repeated.push_back({Rows(recording), found->first});
  }
  seen.emplace_back(Rows(recording), held);
}

void refuse_what_looks_wrong(const FrictionJob& job, const std::vector<LogsLookWrong::Finding>& blocking) {
  if (!blocking.empty() && !job.takes_logs_as_they_are) {
    throw LogsLookWrong(blocking);
  }
}

struct FrictionInput {
  std::vector<FrictionLog> logs;
  std::vector<LogsLookWrong::Finding> blocking;  ///< the suspicions (units, signs, wheel order) that would make the answer wrong if true
};

struct ReadLog {
  recording::Recording recording;
  recording::RecordingReport report;
  FrictionLog log;
};

ReadLog read_log(const FrictionJob& job, const std::string& name, const FrictionLogNeeds& needs, FrictionFindings& findings) {
  ReadLog read;
  const std::filesystem::path file = input::log_named(job.folders, name);
  read.recording = recording::read_recording(file, recording::mapping_for(file, job.map), read.report);
  read.log = friction_log(read.recording, job.robot, needs, findings);
  return read;
}

/// Throws Failure with the problems of all logs.
FrictionInput read_logs(const FrictionJob& job, FrictionLogNeeds needs, FrictionRun& run, const base::Progress& progress) {
  FrictionInput input;
  if (job.motor) {
    needs.drive = robot::drive_constants(job.robot, *job.motor);
  }
  std::vector<std::pair<Rows, std::size_t>> seen;
  std::vector<recording::RowsGivenTwice::Pair> repeated;
  base::CollectedFailures failures;
  for (std::size_t i = 0; i < job.logs.size(); ++i) {
    std::optional<ReadLog> read = failures.attempt([&] { return read_log(job, job.logs[i], needs, run.findings); });
    if (!read) {
      continue;
    }
    const auto& [recording, report, log] = *read;
    const recording::DataQuality quality = recording::assess(recording, report);
    for (const recording::Suspicion& suspicion : quality.suspicions) {
      run.suspicions.push_back({recording.name, suspicion});
    }
    for (const recording::Suspicion& suspicion : quality.blocking_for_wheels) {
      input.blocking.push_back({recording.file.string(), suspicion});
    }
    note_if_repeated(recording, seen, repeated);
    input.logs.push_back(std::move(read->log));
    if (progress) {
      progress(i + 1, job.logs.size());
    }
  }
  failures.throw_if_any();
  if (!repeated.empty()) {
    throw recording::RowsGivenTwice(std::move(repeated));
  }
  return input;
}

std::string source_of(const FrictionJob& job) {
  const std::string first = std::filesystem::path(job.logs.front()).filename().string();
  return job.logs.size() == 1 ? fmt::format("friction test, {}", first)
                              : fmt::format("friction test, {} and {} more logs", first, job.logs.size() - 1);
}

}  // namespace

LogsLookWrong::LogsLookWrong(std::vector<Finding> findings)
    : base::Failure(
          base::ExitCode::bad_input,
          "units, signs or wheels of the logs look wrong; correct them in a mapping (--map) or in the robot's file, or use --as-is "
          "if they are right"),
      findings_(std::move(findings)) {}

NothingIdentifiable::NothingIdentifiable(Reason reason)
    : base::Failure(base::ExitCode::cannot_answer, "nothing is identifiable"), reason_(std::move(reason)) {}

SteadyFriction steady_friction(const FrictionJob& job, const base::Progress& progress) {
  SteadyFriction answer;
  FrictionInput input = read_logs(job, {.direction = job.direction}, answer, progress);
  const robot::Kinematics kinematics = robot::make_kinematics(job.robot);
  answer.steady = find_steady_parts(input.logs, kinematics);
  answer.settings.use_return_legs = job.use_return_legs;
  std::optional<robot::DriveConstants> drive;
  Expectation before;
  if (job.motor) {
    drive = robot::drive_constants(job.robot, *job.motor);
    before = expectation(job.robot, *job.motor);
    answer.settings.known_damping_V_s_per_rad = before.damping_V_s_per_rad;
  }
  answer.fit = fit_friction(answer.steady.parts, kinematics, answer.settings);
  for (const FrictionSuspicion& suspicion : friction_suspicions(answer.steady, answer.fit, kinematics, drive)) {
    answer.suspicions.push_back({{}, suspicion});
    input.blocking.push_back({job.logs.front(), suspicion});
  }
  refuse_what_looks_wrong(job, input.blocking);
  if (!answer.fit.is_learned()) {
    throw NothingIdentifiable({.legs = answer.steady.parts.size(),
                               .headings = static_cast<std::size_t>(answer.fit.headings),
                               .of_first_wheel = answer.fit.wheels.front().problem,
                               .suspicions = answer.suspicions});
  }
  answer.error = error_on_held_out_headings(answer.steady.parts, kinematics, answer.settings, before.voltages);
  answer.expected_from = before.voltages ? std::optional(before.from) : std::nullopt;
  if (job.writes_robot_file) {
    if (!drive) {
      throw base::Failure(base::ExitCode::bad_input,
                          "--out: a robot's file has torques; --motor must name the motor that converts volts to torques");
    }
    answer.robot_text = with_measured_friction(base::read_file(job.robot.file, kLargestRobotFile_bytes), job.robot, *drive, answer.fit,
                                               source_of(job), answer.notes);
  }
  return answer;
}

RollOutFriction roll_out_friction(const FrictionJob& job, const base::Progress& progress) {
  RollOutFriction answer;
  if (!job.motor) {
    throw base::Failure(base::ExitCode::bad_input, "a roll-out needs the inertia of the motor's rotor; --motor must name the motor");
  }
  const FrictionInput input = read_logs(job, {.all_wheels = !job.is_lifted, .voltage = false, .direction = std::nullopt}, answer, progress);
  refuse_what_looks_wrong(job, input.blocking);
  answer.result = roll_out(input.logs, job.robot, *job.motor, job.is_lifted);
  if (answer.result.runs.empty()) {
    throw base::Failure(base::ExitCode::cannot_answer,
                        "nothing is identifiable: in no interval of 15 rows do the wheels roll out with their drivers off");
  }
  answer.drive = robot::drive_constants(job.robot, *job.motor);
  answer.drive.drag_torque_Nm = 0.0;
  if (job.writes_robot_file) {
    answer.robot_text = with_measured_damping(base::read_file(job.robot.file, kLargestRobotFile_bytes), job.robot,
                                              answer.result.wheel_damping_Nm_s_per_rad, source_of(job));
  }
  return answer;
}

}  // namespace heatsoak::friction
