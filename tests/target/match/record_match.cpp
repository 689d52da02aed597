// Records a minute of a match for the drive core on the target, twice: with the sensors of the robot ("match"), which has no current
// sensors, and with current sensors in addition ("sensed"). record_match FOLDER writes into that folder:
//   core_config.h, motor_guard.h, motor_guard.cpp   same text as `heatsoak generate core` writes
//   match_start.bin, sensed_start.bin    MatchStart: Config's check sum and State at the beginning of the minute
//   match_input.bin, sensed_input.bin    inputs of every step: real sensing and radio in the closed loop with the plant
//   match_output.bin, sensed_output.bin  DriveResult of every step, by the host's drive core with the guard of host_guard.h
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "firmware/core_files.h"
#include "simulate/guarded_core.h"
#include "simulate/match_run.h"
#include "support/shipped.h"
#include "target/image/drive_records.h"

namespace heatsoak::target {
namespace {

constexpr std::uint64_t kSeed = 1;
constexpr double kSegment_s = 60.0;
constexpr double kAmbient_C = 25.0;

void write_bytes(const std::filesystem::path& file, const void* data, std::size_t size) {
  std::ofstream stream(file, std::ios::binary);
  stream.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
  if (!stream.flush()) {
    throw base::Failure(base::ExitCode::bug, fmt::format("{} cannot be written", file.string()));
  }
}

template <typename Value>
void write_all(const std::filesystem::path& file, const std::vector<Value>& values) {
  write_bytes(file, values.data(), values.size() * sizeof(Value));
}

/// Writes configuration and guard as source code for the target.
void write_sources(const std::filesystem::path& folder, const robot::Robot& robot, const motor::Motor& motor,
                   const derate::Derating& derating) {
  for (const firmware::CoreFile& file : firmware::core_files(robot, motor, firmware::with_tolerance({}, motor), derating, "test").files) {
    if (file.path == "core_config.h" || file.path.starts_with("motor_guard.")) {
      write_bytes(folder / file.path, file.content.data(), file.content.size());
    }
  }
}

/// Returns the start, in whole seconds, of the first minute that is mostly play and contains a duel, not at the very start.
double segment_start_s(const simulate::Game& game) {
  for (double from_s = 10.0; from_s + kSegment_s < game.duration_s; from_s += 1.0) {
    double play_s = 0.0;
    double duel_s = 0.0;
    for (std::size_t i = 0; i < game.script.size(); ++i) {
      const double end_s = i + 1 < game.script.size() ? game.script[i + 1].time_s : game.duration_s;
      const double inside_s = std::min(end_s, from_s + kSegment_s) - std::max(game.script[i].time_s, from_s);
      play_s += game.script[i].phase == duty::Phase::running ? std::max(0.0, inside_s) : 0.0;
      duel_s += game.script[i].command.duel ? std::max(0.0, inside_s) : 0.0;
    }
    if (play_s > 0.5 * kSegment_s && duel_s > 1.0) {
      return from_s;
    }
  }
  throw base::Failure(base::ExitCode::bug, "the match has no minute of play with a duel");
}

/// Plays the game and writes its last minute, from `start_s` on.
void record_minute(const std::filesystem::path& folder, const std::string& name, const simulate::GuardedCore& core,
                   const simulate::Game& game, const robot::Robot& robot, const motor::Motor& motor, bool has_motor_current,
                   double start_s) {
  simulate::MatchRunOptions options;
  options.ambient_C = kAmbient_C;
  options.drive = simulate::real_drive(robot, kSeed);
  options.drive.sensing.has_motor_current = has_motor_current;
  MatchStart start{};
  std::vector<robot_core::Input> inputs;
  std::vector<DriveResult> results;
  simulate::run_match(game, robot, motor, core.config(), options, [&](const simulate::LoopMoment& moment) {
    const double since_s = moment.time_s - start_s;
    if (since_s > 0.5 * simulate::SimulatedRobot::kPeriod_s) {
      inputs.push_back(moment.drive->input());
      copy_output(moment.drive->output(), moment.drive->state(), results.emplace_back());
    } else if (since_s > -0.5 * simulate::SimulatedRobot::kPeriod_s) {
      start = {moment.drive->config().check_sum, 0, moment.drive->state()};
    }
  });
  write_bytes(folder / (name + "_start.bin"), &start, sizeof(start));
  write_all(folder / (name + "_input.bin"), inputs);
  write_all(folder / (name + "_output.bin"), results);
}

void record(const std::filesystem::path& folder) {
  const robot::Robot robot = twente();
  const motor::Motor motor = ecx_32();
  const simulate::MotorGuard guard = simulate::make_guard(motor, robot, kAmbient_C, 1);
  const simulate::GuardedCore core(robot, motor, simulate::GuardUse::on, guard);
  write_sources(folder, robot, motor, *guard.derating);
  const duty::Duty duty = duty::read_duty(kSource / "duty_profiles/division_a_match.toml");
  simulate::Game game = simulate::play_game(dynamic_cast<const duty::MatchDuty&>(*duty.shape_data).inputs(), robot, kSeed);
  const double start_s = segment_start_s(game);
  game.duration_s = start_s + kSegment_s;
  std::erase_if(game.script, [&](const duty::ScheduledCommand& each) { return each.time_s >= game.duration_s; });
  record_minute(folder, "match", core, game, robot, motor, false, start_s);
  record_minute(folder, "sensed", core, game, robot, motor, true, start_s);
}

}  // namespace
}  // namespace heatsoak::target

int main(int count, char** arguments) {
  try {
    heatsoak::target::record(count == 2 ? arguments[1] : ".");
    return 0;
  } catch (const std::exception& failure) {
    std::cerr << "record_match: " << failure.what() << "\n";
    return 1;
  }
}
