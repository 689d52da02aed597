// A 40-minute duty whose current changes every 0.1 s: compares the methods at equal accuracy. error_K is the largest error of winding or
// stator against the exact solution at any of the 24 000 steps. Every method uses the coarsest tolerance that keeps it below 1e-3 K.
#include <benchmark/benchmark.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>
#include <unsupported/Eigen/MatrixFunctions>
#include <vector>

#include "thermal/ensemble.h"
#include "thermal/transient.h"

namespace heatsoak {
namespace {

constexpr int kPieces = 24000;
constexpr double kPiece_s = 0.1;

const std::vector<thermal::Interval>& duty() {
  static const std::vector<thermal::Interval> kDuty = [] {
    std::mt19937_64 engine(1);
    std::uniform_real_distribution<double> current_A(0.0, 6.0);
    std::uniform_real_distribution<double> speed_rad_per_s(0.0, 400.0);
    std::vector<thermal::Interval> intervals;
    for (int i = 0; i < kPieces; ++i) {
      const double speed = speed_rad_per_s(engine);
      intervals.push_back({kPiece_s, {current_A(engine), speed, speed, 25.0}});
    }
    return intervals;
  }();
  return kDuty;
}

/// The ECX FLAT 32 L: R 1.07 Ω, R_th1 3.8 K/W, R_th2 2.8 K/W, 3.2 and 28.6 J/K.
thermal::Network motor() {
  thermal::Network network;
  network.add_node("winding", 12.0 / 3.8);
  network.add_node("stator", 80.0 / 2.8);
  const auto add = [&network](const char* name, const char* type, std::vector<std::string> nodes, std::vector<double> parameters) {
    network.add_effect(name, *thermal::find_effect(type), nodes, parameters);
  };
  add("copper", "copper_loss", {"winding"}, {1.07, 0.0039});
  add("drag", "no_load_loss", {"stator"}, {0.0082});
  add("inner", "conduction", {"winding", "stator"}, {3.8});
  add("outer", "conduction", {"stator", "ambient"}, {2.8});
  return network;
}

/// Exact solution. The network is linear within a piece: T(t) = exp(M·t)·(T, 1), with one matrix exponential per piece. It supports the
/// two-node network only and therefore cannot be the program's method.
class ExactMap {
 public:
  template <class Visit>
  static Eigen::Vector2d run(const Visit& visit) {
    const thermal::Network network = motor();
    const std::vector<double> values = network.values();
    Eigen::Vector3d state(25.0, 25.0, 1.0);
    for (const thermal::Interval& interval : duty()) {
      state = piece(network, values, interval) * state;
      visit(state);
    }
    return state.head<2>();
  }

 private:
  /// Identifies the affine law from three calls of the rate function.
  static Eigen::Matrix3d piece(const thermal::Network& network, const std::vector<double>& values, const thermal::Interval& interval) {
    Eigen::Matrix3d generator = Eigen::Matrix3d::Zero();
    const auto rate = [&](double winding_C, double stator_C) {
      std::array<double, 3> temperature_C{winding_C, stator_C, 0.0};
      Eigen::Vector2d result;
      network.rate_K_per_s<double>(interval.at, values, temperature_C, std::span(result.data(), 2));
      return result;
    };
    const Eigen::Vector2d at_zero = rate(0.0, 0.0);
    generator.block<2, 1>(0, 0) = rate(1.0, 0.0) - at_zero;
    generator.block<2, 1>(0, 1) = rate(0.0, 1.0) - at_zero;
    generator.block<2, 1>(0, 2) = at_zero;
    return (generator * interval.duration_s).exp();
  }
};

/// Exact winding and stator temperatures at the end of every piece.
const std::vector<Eigen::Vector2d>& exact_C() {
  static const std::vector<Eigen::Vector2d> kExact = [] {
    std::vector<Eigen::Vector2d> all;
    ExactMap::run([&all](const Eigen::Vector3d& state) { all.emplace_back(state.head<2>()); });
    return all;
  }();
  return kExact;
}

double error_K(const thermal::TransientOptions& options) {
  const thermal::Network network = motor();
  double worst_K = 0.0;
  thermal::run_transient(network, network.values(), duty(), options, [&](const thermal::TransientMoment& moment) {
    if (moment.begins_interval && moment.interval > 0) {
      const Eigen::Vector2d& exact = exact_C()[moment.interval - 1];
      worst_K = std::max({worst_K, std::abs(moment.state_C[0] - exact[0]), std::abs(moment.state_C[1] - exact[1])});
    }
  });
  return worst_K;
}

void through_sundials(benchmark::State& state, ode::OdeMethod method, ode::OdeTolerances tolerances, bool with_limits) {
  thermal::TransientOptions options;
  options.method = method;
  options.tolerances = tolerances;
  if (with_limits) {
    options.limits = {{0, 155.0}, {1, 120.0}};
  }
  const thermal::Network network = motor();
  const std::vector<double> values = network.values();
  long calls = 0;
  for (auto _ : state) {
    const thermal::TransientResult result = thermal::run_transient(network, values, duty(), options);
    benchmark::DoNotOptimize(result.end_C.data());
    calls = result.derivative_count;
  }
  state.counters["error_K"] = error_K(options);
  state.counters["calls_per_piece"] = static_cast<double>(calls) / kPieces;
  state.counters["tolerance"] = tolerances.relative;
}

/// Returns the coarsest power of ten with an error below 1e-3 K.
ode::OdeTolerances coarsest(ode::OdeMethod method) {
  ode::OdeTolerances tolerances{1e-2, 1e-2};
  for (; tolerances.relative > 1e-13; tolerances.relative /= 10.0, tolerances.absolute /= 10.0) {
    thermal::TransientOptions options;
    options.method = method;
    options.tolerances = tolerances;
    if (error_K(options) <= 1e-3) {
      break;
    }
  }
  return tolerances;
}

void duty_24000_at_1mK(benchmark::State& state, ode::OdeMethod method) { through_sundials(state, method, coarsest(method), true); }
void duty_24000_as_used(benchmark::State& state, ode::OdeMethod method) { through_sundials(state, method, {}, true); }

BENCHMARK_CAPTURE(duty_24000_at_1mK, cvodes_bdf, ode::OdeMethod::cvodes_bdf)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(duty_24000_at_1mK, cvodes_adams, ode::OdeMethod::cvodes_adams)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(duty_24000_at_1mK, arkode_erk, ode::OdeMethod::arkode_erk)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(duty_24000_as_used, cvodes_bdf, ode::OdeMethod::cvodes_bdf)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(duty_24000_as_used, cvodes_adams, ode::OdeMethod::cvodes_adams)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(duty_24000_as_used, arkode_erk, ode::OdeMethod::arkode_erk)->Unit(benchmark::kMillisecond);

void duty_24000_matrix_exponential(benchmark::State& state) {
  for (auto _ : state) {
    const Eigen::Vector2d end_C = ExactMap::run([](const Eigen::Vector3d&) {});
    benchmark::DoNotOptimize(end_C);
  }
  state.counters["error_K"] = 0.0;
}
BENCHMARK(duty_24000_matrix_exponential)->Unit(benchmark::kMillisecond);

/// Eight samples at once, as in Monte Carlo runs; one of them is compared. The time is for all eight.
void duty_24000_eight_lanes(benchmark::State& state) {
  const thermal::Network network = motor();
  std::vector<thermal::Lanes> values;
  for (const double value : network.values()) {
    values.push_back(thermal::Lanes::Constant(value));
  }
  double worst_K = 0.0;
  for (auto _ : state) {
    thermal::EnsembleRun run(network, values, std::vector<thermal::Lanes>(2, thermal::Lanes::Constant(25.0)));
    worst_K = 0.0;
    for (std::size_t i = 0; i < duty().size(); ++i) {
      const thermal::OperatingPoint<double>& one = duty()[i].at;
      const thermal::OperatingPoint<thermal::Lanes> at{
          thermal::Lanes::Constant(one.current_rms_A), thermal::Lanes::Constant(one.speed_mean_rad_per_s),
          thermal::Lanes::Constant(one.speed_rms_rad_per_s), thermal::Lanes::Constant(one.ambient_C)};
      run.over(duty()[i].duration_s, at, thermal::longest_step_s(network, values, at));
      worst_K = std::max({worst_K, std::abs(run.state_C()[0][0] - exact_C()[i][0]), std::abs(run.state_C()[1][0] - exact_C()[i][1])});
    }
  }
  state.counters["error_K"] = worst_K;
}
BENCHMARK(duty_24000_eight_lanes)->Unit(benchmark::kMillisecond);

void rate_of_one(benchmark::State& state) {
  const thermal::Network network = motor();
  const std::vector<double> values = network.values();
  std::array<double, 3> temperature_C{80.0, 50.0, 25.0};
  std::array<double, 2> rate{};
  for (auto _ : state) {
    network.rate_K_per_s<double>(duty()[0].at, values, temperature_C, rate);
    benchmark::DoNotOptimize(rate);
  }
}
BENCHMARK(rate_of_one);

}  // namespace
}  // namespace heatsoak
