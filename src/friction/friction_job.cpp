#include "friction/friction_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
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

/// Rows of a log and the content_hash() that identifies them.
using KnownRows = std::pair<recording::RowsGivenTwice::Rows, std::string>;

/// Throws RowsGivenTwice with all logs that are given twice, because they would make the intervals too narrow.
void refuse_repeated(const std::vector<KnownRows>& logs) {
  std::vector<recording::RowsGivenTwice::Pair> repeated;
  for (auto log = logs.begin(); log != logs.end(); ++log) {
    const auto earlier = std::find_if(logs.begin(), log, [&](const KnownRows& each) { return each.second == log->second; });
    if (earlier != log) {
      repeated.push_back({log->first, earlier->first});
    }
  }
  if (!repeated.empty()) {
    throw recording::RowsGivenTwice(std::move(repeated));
  }
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

recording::Recording read_log(const FrictionJob& job, const std::string& name, recording::RecordingReport& report) {
  const std::filesystem::path file = input::log_named(job.folders, name);
  return recording::read_recording(file, recording::mapping_for(file, job.map), report);
}

void assess(const recording::Recording& recording, const recording::RecordingReport& report, const FrictionJob& job, FrictionInput& input,
            FrictionRun& run) {
  const recording::DataQuality quality = recording::assess(recording, report);
  for (const recording::Suspicion& suspicion : quality.suspicions) {
    run.suspicions.push_back({recording.name, suspicion});
  }
  for (const recording::Suspicion& suspicion : quality.blocking_for_wheels) {
    input.blocking.push_back({recording.file.string(), suspicion});
  }
  const std::size_t wheels = job.robot.wheels.axis_rad.size();
  if (const std::size_t logged = last_wheel(recording); logged > wheels) {
    run.suspicions.push_back({recording.name, MoreWheelsThanRobot{logged, wheels}});
    input.blocking.push_back({recording.file.string(), MoreWheelsThanRobot{logged, wheels}});
  }
}

/// Throws the problems of all logs if any cannot be used; the caller refuses logs that only look wrong.
FrictionInput read_logs(const FrictionJob& job, FrictionLogNeeds needs, FrictionRun& run, const base::Progress& progress) {
  FrictionInput input;
  if (job.motor) {
    needs.drive = robot::drive_constants(job.robot, *job.motor);
  }
  std::vector<KnownRows> read;
  base::CollectedFailures failures;
  for (std::size_t i = 0; i < job.logs.size(); ++i) {
    recording::RecordingReport report;
    std::optional<recording::Recording> recording = failures.attempt([&] { return read_log(job, job.logs[i], report); });
    if (recording) {
      assess(*recording, report, job, input, run);
      failures.attempt([&] { input.logs.push_back(friction_log(*recording, job.robot, needs, run.findings)); });
      read.emplace_back(recording::RowsGivenTwice::Rows(*recording), recording->content);
    }
    if (progress) {
      progress(i + 1, job.logs.size());
    }
  }
  failures.attempt([&] { refuse_repeated(read); });
  if (!failures.empty()) {
    failures.attempt([&] { refuse_what_looks_wrong(job, input.blocking); });
  }
  failures.throw_if_any();
  return input;
}

std::string source_of(const FrictionJob& job) {
  const std::string first = std::filesystem::path(job.logs.front()).filename().string();
  return job.logs.size() == 1 ? fmt::format("friction test, {}", first)
                              : fmt::format("friction test, {} and {} more logs", first, job.logs.size() - 1);
}

SteadyFriction steady_friction(const FrictionJob& job, const base::Progress& progress) {
  SteadyFriction answer;
  if (job.writes_robot_file && !job.motor) {
    throw base::Failure(base::ExitCode::bad_input,
                        "--out: a robot's file has torques; --motor must name the motor that converts volts to torques");
  }
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

}  // namespace

LogsLookWrong::LogsLookWrong(std::vector<Finding> findings)
    : base::Failure(
          base::ExitCode::bad_input,
          "units, signs or wheels of the logs look wrong; correct them in a mapping (--map) or in the robot's file, or use --as-is "
          "if they are right"),
      findings_(std::move(findings)) {}

NothingIdentifiable::NothingIdentifiable(Reason reason)
    : base::Failure(base::ExitCode::cannot_answer, "nothing is identifiable"), reason_(std::move(reason)) {}

const std::string& robot_text(const FrictionAnswer& answer) {
  return std::visit([](const FrictionRun& run) -> const std::string& { return run.robot_text; }, answer);
}

FrictionAnswer run_friction(const FrictionJob& job, const base::Progress& progress) {
  if (job.method == FrictionMethod::roll_out) {
    return roll_out_friction(job, progress);
  }
  return steady_friction(job, progress);
}

}  // namespace heatsoak::friction
