// Evaluates the whole database for the duty of the paper.
#include <benchmark/benchmark.h>

#include <filesystem>

#include "select/evaluate.h"
#include "support/source_folder.h"

namespace heatsoak {
namespace {

std::vector<motor::Motor> all_motors() {
  std::vector<motor::Motor> motors;
  for (const auto& file : std::filesystem::directory_iterator(kSource / "motor_db")) {
    if (file.path().extension() == ".toml") {
      motors.push_back(motor::read_motor(file.path()));
    }
  }
  return motors;
}

void evaluate_database(benchmark::State& state, int samples, bool with_curves) {
  const robot::Robot robot = robot::read_robot(kSource / "robot_core/robots/roboteam_twente_v2024.toml");
  const duty::Duty duty = duty::read_duty(kSource / "duty_profiles/paper_intermittent.toml");
  const std::vector<motor::Motor> motors = all_motors();
  for (auto _ : state) {
    benchmark::DoNotOptimize(select::evaluate(robot, duty, duty.demand(robot, 1), motors,
                                              {.samples = samples, .with_curves = with_curves, .with_bands = with_curves})
                                 .data());
  }
  state.counters["motors"] = static_cast<double>(motors.size());
}
BENCHMARK_CAPTURE(evaluate_database, nominal, 0, false)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(evaluate_database, samples_500, 500, false)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(evaluate_database, samples_500_with_curves, 500, true)->Unit(benchmark::kMillisecond)->UseRealTime();

/// A duty of 40 minutes in pieces of 0.1 s, like a recorded one, with all curves that a picture needs.
void evaluate_long_recording(benchmark::State& state, bool with_curves) {
  constexpr int kRecordedPieces = 24'000;
  const robot::Robot robot = robot::read_robot(kSource / "robot_core/robots/roboteam_twente_v2024.toml");
  duty::Duty duty = duty::read_duty(kSource / "duty_profiles/paper_intermittent.toml");
  const std::vector<motor::Motor> motors{motor::read_motor(kSource / "motor_db/maxon_ecx_flat_32l_48v.toml")};
  duty::WheelDemand wheel{.wheel = "wheel 1", .bins = {}, .points = {}};
  for (int i = 0; i < kRecordedPieces; ++i) {
    wheel.bins.push_back(duty::constant_bin(0.1, 0.01 * (i % 20), 5.0 * (i % 17), 0.0));
  }
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        select::evaluate(robot, duty, std::span(&wheel, 1), motors, {.samples = 500, .with_curves = with_curves, .with_bands = with_curves})
            .data());
  }
}
BENCHMARK_CAPTURE(evaluate_long_recording, values, false)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(evaluate_long_recording, values_and_curves, true)->Unit(benchmark::kMillisecond)->UseRealTime();

void read_database(benchmark::State& state) {
  for (auto _ : state) {
    benchmark::DoNotOptimize(all_motors().data());
  }
}
BENCHMARK(read_database)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace heatsoak
