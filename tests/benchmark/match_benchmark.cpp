// A 40-minute match of one robot at 1 kHz, 2.4 million steps of four wheels: as the game's generator plays it (inverse
// dynamics), and in the closed loop (controller and plant with slip, battery and warming motors).
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <filesystem>

#include "simulate/match_run.h"
#include "support/shipped.h"

namespace heatsoak {
namespace {

constexpr double kLength_s = 2400.0;

/// Division A with overtime, its stops stretched until the game has the length.
MatchInputs forty_minutes(MatchValues& values) {
  const Duty duty = read_duty(kSource / "duty_profiles/division_a_match.toml");
  MatchInputs inputs = dynamic_cast<const MatchDuty&>(*duty.shape_data).inputs();
  inputs.overtime = true;
  values = inputs.nominal();
  double length_s = 0.0;
  for (values.stop_mean_s = 1.0; length_s < kLength_s; values.stop_mean_s += 0.1) {
    Random random(1, 0);
    length_s = 0.0;
    for (const MatchPhase& span : generate_game(inputs.division, inputs.overtime, values, random)) {
      length_s += span.duration_s;
    }
  }
  inputs.figures[1].value = values.stop_mean_s;
  return inputs;
}

double resident_MB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

void match_40_minutes_generated(benchmark::State& state) {
  MatchValues values;
  const MatchInputs inputs = forty_minutes(values);
  MatchLoad load;
  for (auto _ : state) {
    load = play_match(inputs, values, twente(), 1, Planner::jerk_limited);
  }
  state.counters["length_s"] = load.duration_s;
  state.counters["resident_MB"] = resident_MB();
}
BENCHMARK(match_40_minutes_generated)->Unit(benchmark::kMillisecond);

void match_40_minutes_closed_loop(benchmark::State& state) {
  MatchValues values;
  const MatchInputs inputs = forty_minutes(values);
  const Motor motor = read_motor(kSource / "motor_db/maxon_ecx_flat_32l_48v.toml");
  MatchRun run;
  for (auto _ : state) {
    run = run_match(inputs, twente(), motor, {});
  }
  state.counters["length_s"] = run.score.time_s;
  state.counters["resident_MB"] = resident_MB();
}
BENCHMARK(match_40_minutes_closed_loop)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace heatsoak
