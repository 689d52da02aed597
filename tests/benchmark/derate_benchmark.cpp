// The search for a safety factor on heat, and one step of the observer compared with the network's equations.
#include <benchmark/benchmark.h>

#include "derate/derating.h"
#include "motor/datasheet_network.h"
#include "support/shipped.h"

namespace heatsoak {
namespace {

void derate_motor(benchmark::State& state) {
  const motor::Motor motor = ecx_32();
  const robot::Robot robot = twente();
  for (auto _ : state) {
    benchmark::DoNotOptimize(derate::derate(motor, robot, {}).table.heat_per_ohm_A2.data());
  }
}
BENCHMARK(derate_motor)->Unit(benchmark::kMillisecond)->UseRealTime();

void derate_table_alone(benchmark::State& state) {
  const motor::Motor motor = ecx_32();
  const thermal::Network network = motor::datasheet_network(motor, motor::nominal_sample(motor));
  const derate::Observer observer(network, motor.nominal, twente(), 1.5);
  derate::BarrierRules rules;
  rules.limits.winding_C = motor.nominal.winding_limit_C;
  rules.most_current_A = 24.0;
  rules.most_speed_rad_per_s = 400.0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(derate::current_table(observer, rules).heat_per_ohm_A2.data());
  }
}
BENCHMARK(derate_table_alone)->Unit(benchmark::kMillisecond);

void observer_step(benchmark::State& state) {
  const motor::Motor motor = ecx_32();
  const thermal::Network network = motor::datasheet_network(motor, motor::nominal_sample(motor));
  const derate::Observer observer(network, motor.nominal, twente(), 1.5);
  derate::ObserverRun<float> run(observer, 0.01F, 40.0F);
  std::array<float, derate::observed::kSignalCount> signals{2.0F, 100.0F, 40.0F, 0.0F, 40.0F, 0.0F, 0.0F};
  for (auto _ : state) {
    run.step(signals);
    benchmark::DoNotOptimize(run.state_C().data());
  }
}
BENCHMARK(observer_step);

void network_rate_in_double(benchmark::State& state) {
  const motor::Motor motor = ecx_32();
  const thermal::Network network = motor::datasheet_network(motor, motor::nominal_sample(motor));
  const std::vector<double> parameters = network.values();
  thermal::OperatingPoint<double> at;
  at.current_rms_A = 2.0;
  at.speed_mean_rad_per_s = at.speed_rms_rad_per_s = 100.0;
  std::array<double, 3> state_C{80.0, 60.0, 40.0};
  std::array<double, 2> rate_K_per_s{};
  for (auto _ : state) {
    network.rate_K_per_s<double>(at, parameters, state_C, rate_K_per_s);
    benchmark::DoNotOptimize(rate_K_per_s.data());
  }
}
BENCHMARK(network_rate_in_double);

}  // namespace
}  // namespace heatsoak
