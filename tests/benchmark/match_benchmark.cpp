// A 40-minute match of one robot at 1 kHz, 2.4 million steps of four wheels. Measures the game's generator (inverse dynamics) and the
// closed loop (drive core and plant with slip, battery and warming motors). Also splits the time of the loop into its parts.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <limits>

#include "simulate/guarded_core.h"
#include "simulate/match_run.h"
#include "support/shipped.h"

namespace heatsoak {
namespace {

constexpr double kLength_s = 2400.0;

/// Division A with overtime; stoppages are lengthened until the game has the required duration.
duty::MatchInputs forty_minutes(duty::MatchValues& values) {
  const duty::Duty duty = duty::read_duty(kSource / "duty_profiles/division_a_match.toml");
  duty::MatchInputs inputs = dynamic_cast<const duty::MatchDuty&>(*duty.shape_data).inputs();
  inputs.overtime = true;
  values = inputs.nominal();
  double length_s = 0.0;
  for (values.stop_mean_s = 1.0; length_s < kLength_s; values.stop_mean_s += 0.1) {
    base::Random random(1, 0);
    length_s = 0.0;
    for (const duty::MatchPhase& span : duty::generate_game(inputs.division, inputs.overtime, values, random)) {
      length_s += span.duration_s;
    }
  }
  inputs.parameters[1].value = values.stop_mean_s;
  return inputs;
}

double resident_MB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

void match_40_minutes_generated(benchmark::State& state) {
  duty::MatchValues values;
  const duty::MatchInputs inputs = forty_minutes(values);
  duty::MatchLoad load;
  for (auto _ : state) {
    load = duty::play_match(inputs, values, twente(), 1, duty::Planner::jerk_limited);
  }
  state.counters["length_s"] = load.duration_s;
  state.counters["resident_MB"] = resident_MB();
}
BENCHMARK(match_40_minutes_generated)->Unit(benchmark::kMillisecond);

void match_40_minutes_closed_loop(benchmark::State& state) {
  duty::MatchValues values;
  const duty::MatchInputs inputs = forty_minutes(values);
  const motor::Motor motor = motor::read_motor(kSource / "motor_db/maxon_ecx_flat_32l_48v.toml");
  const simulate::GuardedCore core(twente(), motor, simulate::GuardUse::off, {});
  simulate::MatchRunOptions options;
  options.drive = simulate::real_drive(twente(), 1);
  simulate::MatchRun run;
  for (auto _ : state) {
    run = simulate::run_match(simulate::play_game(inputs, twente(), 1), twente(), motor, core.config(), options);
  }
  state.counters["length_s"] = run.score.time_s;
  state.counters["resident_MB"] = resident_MB();
}
BENCHMARK(match_40_minutes_closed_loop)->Unit(benchmark::kMillisecond);

constexpr double kLoop_s = 60.0;

/// A target every 1.5 s, so that most plans are interrupted, as in play.
std::vector<duty::ScheduledCommand> restless() {
  std::vector<duty::ScheduledCommand> script;
  for (int i = 0; 1.5 * i < kLoop_s; ++i) {
    duty::MotionCommand command;
    command.x_m = 2.0 * std::sin(1.7 * i);
    command.y_m = 1.5 * std::cos(2.9 * i);
    command.yaw_rad = std::sin(0.6 * i);
    script.push_back({1.5 * i, duty::Phase::running, command});
  }
  return script;
}

/// Inputs that one run of the loop passed to the core and to the plant.
struct Record {
  std::vector<robot_core::Input> inputs;
  std::vector<std::array<robot::MotorCommand, robot::kMostWheels>> commands;
};

/// Processor time of this program: on a busy machine the time on the wall says little.
double processor_s() { return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC); }

double drive_loop(const robot::Robot& robot, const motor::Motor& motor, const robot_core::Config& config, Record* record) {
  simulate::SimulatedRobot simulated(robot, motor, 25.0);
  simulate::CoreDrive drive(config, simulated, simulate::real_drive(robot, 1));
  const std::unique_ptr<duty::Follower> plan = duty::ideal_tracking(robot, 1.0, duty::Planner::jerk_limited);
  const double start_s = processor_s();
  simulate::drive_script(simulated, drive, *plan, restless(), kLoop_s, [&](const simulate::LoopMoment& moment) {
    if (record != nullptr) {
      record->inputs.push_back(moment.drive->input());
      record->commands.push_back(moment.drive->commands());
    }
  });
  return processor_s() - start_s;
}

double replay_core_s(const robot_core::Config& config, const Record& record) {
  robot_core::State state{};
  robot_core::start(config, state, {true, 25.0F});
  const double start_s = processor_s();
  for (const robot_core::Input& input : record.inputs) {
    benchmark::DoNotOptimize(robot_core::step(config, state, input));
  }
  return processor_s() - start_s;
}

double replay_plant_s(const robot::Robot& robot, const motor::Motor& motor, const Record& record, bool with_sensors) {
  simulate::SimulatedRobot simulated(robot, motor, 25.0);
  simulate::Sensing sensing(simulate::sensing_of(robot), simulated, simulate::SimulatedRobot::kPeriod_s, 1);
  robot_core::Input input;
  const double start_s = processor_s();
  for (const std::array<robot::MotorCommand, robot::kMostWheels>& command : record.commands) {
    const robot::PlantOutput& out = simulated.advance(command, {});
    if (with_sensors) {
      sensing.follow(simulated, out);
      sensing.sample(simulated, 25.0, input);
      benchmark::DoNotOptimize(input);
    }
  }
  return processor_s() - start_s;
}

/// Shortest of some runs, in ns per step: the differences between parts are smaller than the noise of one run.
template <class Run>
double shortest_ns(double steps, Run&& run) {
  double least_s = run();
  for (int i = 1; i < 9; ++i) {
    least_s = std::min(least_s, run());
  }
  return 1e9 * least_s / steps;
}

/// Uses one CPU core. The parts are measured by replaying the same run, because clocks inside the loop would cost as much as the parts. The
/// counter `rest` covers planner, radio and the loop itself.
void closed_loop_1kHz(benchmark::State& state) {
  const robot::Robot robot = twente();
  const motor::Motor motor = ecx_32();
  const simulate::MotorGuard guard = simulate::make_guard(motor, robot, 25.0, 0);
  const simulate::GuardedCore guarded(robot, motor, simulate::GuardUse::shadow, guard);
  const simulate::GuardedCore bare(robot, motor, simulate::GuardUse::off, {});
  double whole_s = std::numeric_limits<double>::infinity();
  for (auto _ : state) {
    // Other programs only add time, so the shortest run counts, as for the parts.
    whole_s = std::min(whole_s, drive_loop(robot, motor, guarded.config(), nullptr));
  }
  Record record;
  drive_loop(robot, motor, guarded.config(), &record);
  const auto steps = static_cast<double>(record.inputs.size());
  const double whole_ns = 1e9 * whole_s / steps;
  const double core_ns = shortest_ns(steps, [&] { return replay_core_s(bare.config(), record); });
  const double guard_ns = shortest_ns(steps, [&] { return replay_core_s(guarded.config(), record); }) - core_ns;
  const double plant_ns = shortest_ns(steps, [&] { return replay_plant_s(robot, motor, record, false); });
  const double sensing_ns = shortest_ns(steps, [&] { return replay_plant_s(robot, motor, record, true); }) - plant_ns;
  state.counters["steps_per_s"] = 1e9 / whole_ns;
  state.counters["step_ns"] = whole_ns;
  state.counters["plant_ns"] = plant_ns;
  state.counters["core_ns"] = core_ns;
  state.counters["guard_ns"] = guard_ns;
  state.counters["sensing_ns"] = sensing_ns;
  state.counters["rest_ns"] = whole_ns - plant_ns - core_ns - guard_ns - sensing_ns;
}
BENCHMARK(closed_loop_1kHz)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace heatsoak
