// A match at 1 kHz has 2.4 million steps. Measures one step of the inverse dynamics (wheel demands of a motion) and of the plant.
#include <benchmark/benchmark.h>

#include <cmath>
#include <filesystem>
#include <optional>

#include "motor/motor.h"
#include "robot/inverse_dynamics.h"
#include "robot/plant.h"
#include "simulate/simulated_robot.h"
#include "support/shipped.h"

namespace heatsoak {
namespace {

const char* const kMotor = "nanotec_df45l024048_a2";

/// Returns a different motion for every step, within the grip of the ground.
robot::BodyMotion motion_at(double time_s) {
  const double wave = time_s - std::floor(time_s);
  return {{1.0 + wave, 0.3 - wave, 2.0 * wave}, {wave, 1.0, -wave}, {}, 0.05};
}

void wheel_demands(benchmark::State& state, const char* id) {
  const robot::BodyConfig body = robot::make_body(shipped_robot(id), shipped_motor(kMotor).nominal);
  double time_s = 0.0;
  for (auto each : state) {
    (void)each;
    benchmark::DoNotOptimize(robot::inverse_dynamics(body, motion_at(time_s += 0.001)));
  }
}
BENCHMARK_CAPTURE(wheel_demands, roller_drag, "tigers_v2020");
BENCHMARK_CAPTURE(wheel_demands, measured_heading, "roboteam_twente_v2024");

void plant_step(benchmark::State& state, double command_V) {
  const robot::PlantConfig plant = robot::make_plant(shipped_robot("tigers_v2020"), shipped_motor(kMotor).nominal, 0.001);
  robot::PlantState at = robot::plant_at_rest(plant);
  robot::PlantInput input;
  for (int i = 0; i < robot::kMostWheels; ++i) {
    input.command[i] = {robot::MotorCommand::Kind::voltage, i == 0 || i == 3 ? command_V : -command_V};
  }
  for (auto each : state) {
    (void)each;
    benchmark::DoNotOptimize(robot::step(plant, at, input));
  }
}
BENCHMARK_CAPTURE(plant_step, ordinary, 3.0);
BENCHMARK_CAPTURE(plant_step, bus_is_the_limit, 100.0);

/// The plant with its energy balance and the motors' thermal network, per millisecond of simulated time. Compare with 1 µs: the closed loop
/// with drive core and guard needs 1,000,000 steps/s. The difference to plant_step/ordinary is the cost of balance and network. The voltage
/// changes its sign every half second, so that all regimes of a drive occur and the battery lasts.
void simulated_robot_advance(benchmark::State& state, const char* id, robot::MotorCommand::Kind kind, double amplitude) {
  constexpr int kHalfPeriod_steps = 500;
  constexpr int kBatteryLasts_steps = 200'000;
  const robot::Robot robot = shipped_robot(id);
  const motor::Motor motor = shipped_motor(kMotor);
  std::array<std::array<robot::MotorCommand, robot::kMostWheels>, 2> commands;
  for (int i = 0; i < robot::kMostWheels; ++i) {
    const double ahead = i == 0 || i == 3 ? amplitude : -amplitude;
    commands[0][i] = {kind, ahead};
    commands[1][i] = {kind, -ahead};
  }
  std::optional<simulate::SimulatedRobot> driven;
  driven.emplace(robot, motor, 25.0);
  int steps = 0;
  for (auto each : state) {
    (void)each;
    benchmark::DoNotOptimize(driven->advance(commands[(steps / kHalfPeriod_steps) % 2], {}));
    if (++steps == kBatteryLasts_steps) {
      state.PauseTiming();
      driven.emplace(robot, motor, 25.0);
      steps = 0;
      state.ResumeTiming();
    }
  }
}
BENCHMARK_CAPTURE(simulated_robot_advance, voltage, "tigers_v2020", robot::MotorCommand::Kind::voltage, 3.0);
BENCHMARK_CAPTURE(simulated_robot_advance, current, "tigers_v2020", robot::MotorCommand::Kind::current, 1.0);
BENCHMARK_CAPTURE(simulated_robot_advance, measured_heading, "roboteam_twente_v2024", robot::MotorCommand::Kind::voltage, 3.0);

}  // namespace
}  // namespace heatsoak
