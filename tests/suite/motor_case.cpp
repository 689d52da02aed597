#include "motor_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

namespace heatsoak::suite {
namespace {

/// Everything of a run but the temperatures.
struct Run {
  std::string name;
  Inputs inputs{};
  UnknownHeats unknown{};
  std::vector<double> start_C{};
};

std::vector<double> drawn_start_C(const Motor& motor, bool is_bench, double ambient_C, Random random) {
  const double stator_rise_K = is_bench ? random.uniform(0.0, 3.0) : random.uniform(0.0, 25.0);
  const double winding_rise_K = stator_rise_K + (is_bench ? random.uniform(-0.5, 0.5) : random.uniform(-1.0, 8.0));
  std::vector<double> start_C(motor.network.bodies.size(), ambient_C + stator_rise_K);
  for (const Part& part : motor.winding) {
    start_C[part.body] = ambient_C + winding_rise_K;
  }
  if (start_C.size() == 8) {
    start_C[7] = ambient_C + 0.5 * stator_rise_K;  // the mount is colder
  }
  return start_C;
}

/// Runs of a motor. `base` is the motor without effects, so bodies of effects have no start temperature yet.
std::vector<Run> runs_of(const MotorCase& made, const Motor& base, std::uint64_t seed) {
  const std::string& id = made.plan.id;
  const std::size_t trains = 3 + Random(seed, id + "/runs").index(2);
  std::vector<Run> runs;
  for (std::size_t i = 0; i < trains + 2; ++i) {
    Run run{.name = i < trains ? fmt::format("train_{}", i + 1) : fmt::format("holdout_{}", i + 1 - trains)};
    const std::string label = fmt::format("{}/{}", id, run.name);
    const std::uint64_t drive_seed = seed_of(seed, label + "/drive");
    run.inputs = i == 0 ? bench_run(base, made.load_factor, drive_seed) : wheel_run(base, made.load_factor, drive_seed);
    const UnknownHeat kind = made.plan.unknown_heat;
    run.unknown.winding_W =
        unknown_heat_W(kind, made.unknown_winding_W, run.inputs.size(), kStep_s, Random(seed, label + "/unknown_winding"));
    run.unknown.stator_W = unknown_heat_W(kind, made.unknown_stator_W, run.inputs.size(), kStep_s, Random(seed, label + "/unknown_stator"));
    run.start_C = drawn_start_C(base, i == 0, run.inputs.front().ambient_C, Random(seed, label + "/start"));
    runs.push_back(std::move(run));
  }
  return runs;
}

/// Simulates runs. Returns nothing if a winding gets hotter than allowed.
std::vector<std::vector<Temperatures>> temperatures_of(const Motor& motor, const std::vector<Run>& runs) {
  std::vector<std::vector<Temperatures>> all;
  for (const Run& run : runs) {
    all.push_back(simulate(motor, run.inputs, run.unknown, run.start_C));
    if (std::ranges::max(all.back(), {}, &Temperatures::winding_C).winding_C > motor.nominal.hottest_C) {
      return {};
    }
  }
  return all;
}

std::vector<Log> logs_of(const MotorCase& made, const std::vector<Run>& runs, const std::vector<std::vector<Temperatures>>& truth,
                         std::uint64_t seed) {
  std::vector<Log> logs;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    logs.push_back(measured(rows_of(runs[i].inputs), truth[i], made.noise, Random(seed, made.plan.id + "/" + runs[i].name + "/sensors")));
  }
  return logs;
}

/// Fits the training logs of a motor with other effects in the same runs.
TwoBodyFit fit_of(const MotorCase& made, const Motor& motor, std::vector<Run> runs, std::uint64_t seed) {
  runs.resize(runs.size() - 2);
  std::vector<std::vector<Temperatures>> truth;
  for (const Run& run : runs) {
    truth.push_back(simulate(motor, run.inputs, run.unknown, run.start_C));
  }
  return fit_two_bodies(*made.plan.family, logs_of(made, runs, truth, seed));
}

double error_ratio(const TwoBodyFit& with, const TwoBodyFit& without) {
  return std::max(with.winding_rmse_K / without.winding_rmse_K, with.stator_rmse_K / without.stator_rmse_K);
}

}  // namespace

MotorCase make_case(const CasePlan& plan, std::uint64_t seed) {
  MotorCase made{.plan = plan};
  Random sizes(seed, plan.id + "/unknown");
  made.unknown_winding_W = sizes.uniform(0.0, 0.1) * plan.family->scale;
  made.unknown_stator_W = sizes.uniform(0.0, 0.1) * plan.family->scale;
  made.noise = drawn_noise(Random(seed, plan.id + "/noise"));
  const Random draw(seed, plan.id + "/motor");
  const Motor base = plan.has_eight_bodies ? eight_body_motor(*plan.family, draw) : two_body_motor(*plan.family, draw);
  made.motor = base;
  for (const PlannedEffect& effect : plan.effects) {
    effect.kind->add(made.motor, effect.strength);
  }
  std::vector<Run> runs;
  std::vector<std::vector<Temperatures>> truth;
  for (made.load_factor = 1.15; truth.empty(); made.load_factor *= 0.9) {
    runs = runs_of(made, base, seed);
    truth = temperatures_of(made.motor, runs);
    if (!truth.empty()) {
      break;
    }
  }
  std::vector<Log> logs = logs_of(made, runs, truth, seed);
  made.train.assign(logs.begin(), logs.end() - 2);
  made.holdout.assign(logs.end() - 2, logs.end());
  made.fit = fit_two_bodies(*plan.family, made.train);
  made.fit_without = plan.effects.empty() ? made.fit : fit_of(made, base, runs, seed);
  for (const PlannedEffect& effect : plan.effects) {
    Motor alone = base;
    effect.kind->add(alone, effect.strength);
    const TwoBodyFit fit = plan.effects.size() == 1 ? made.fit : fit_of(made, alone, runs, seed);
    made.error_ratio.push_back(error_ratio(fit, made.fit_without));
  }
  return made;
}

void write_case(const MotorCase& made, std::uint64_t seed, const std::filesystem::path& out) {
  const std::filesystem::path folder = out / made.plan.id;
  std::filesystem::remove_all(folder);  // another seed can have left a fourth training log
  std::filesystem::create_directories(folder);
  for (std::size_t i = 0; i < made.train.size(); ++i) {
    std::ofstream(folder / fmt::format("train_{}.csv", i + 1)) << csv_of(made.train[i]);
  }
  for (std::size_t i = 0; i < made.holdout.size(); ++i) {
    std::ofstream(folder / fmt::format("holdout_{}.csv", i + 1)) << csv_of(made.holdout[i]);
  }
  std::ofstream(folder / "start.toml") << start_file(*made.plan.family);
  std::ofstream(folder / "truth.json") << truth_of(made, seed).dump(1) << '\n';
}

}  // namespace heatsoak::suite
