#include "derate/sensed/sensor_fault.h"

#include <algorithm>
#include <cmath>

#include "robot/motor_drive.h"
#include "thermal/transient.h"

namespace heatsoak::derate {
namespace {

constexpr std::uint64_t kSensorFaultStream = std::uint64_t{1} << 42U;

std::vector<UsePlayed> play_all(const SensorPlan& plan, const Derating& model_only, const motor::Motor& motor, const robot::Robot& robot,
                                std::span<const LoadPattern> uses, double gain_A, double start_C) {
  std::vector<UsePlayed> played(uses.size());
  base::in_parallel(uses.size(), model_only.options.guarantee.threads,
                    [&](std::size_t i) { played[i] = play_sensor_fault(plan, model_only, motor, robot, uses[i], gain_A, start_C); });
  return played;
}

/// Peak of the nominal motor over all uses.
struct NominalPeak {
  double winding_C = 0.0;
  bool is_over = false;
};

NominalPeak nominal_peak(const motor::Motor& motor, const TemperatureLimits& limits, std::span<const UsePlayed> uses) {
  const thermal::Network network = motor::datasheet_network(motor, motor::nominal_sample(motor));
  NominalPeak peak;
  for (const UsePlayed& each : uses) {
    thermal::TransientOptions options;
    options.start_C.assign(static_cast<std::size_t>(network.state_count()), each.start_C.value());
    const thermal::TransientResult result = thermal::run_transient(network, network.values(), each.intervals, options);
    peak.winding_C = std::max(peak.winding_C, result.peak_C[motor::states::winding]);
    peak.is_over = peak.is_over || result.peak_C[motor::states::winding] > limits.winding_C ||
                   (limits.stator_C && result.peak_C[motor::states::stator] > *limits.stator_C);
  }
  return peak;
}

}  // namespace

UsePlayed play_sensor_fault(const SensorPlan& plan, const Derating& model_only, const motor::Motor& motor, const robot::Robot& robot,
                            const LoadPattern& use, double gain_A, double start_C) {
  const BarrierRules& rules = model_only.rules;
  const double period_s = model_only.options.period_s;
  UsePlayed result;
  result.use = use;
  result.start_C = start_C;
  ObserverRun<float> capped(model_only.observer, static_cast<float>(period_s), static_cast<float>(start_C));
  PlayedIntervals intervals(result, motor, robot, rules);
  const auto periods = static_cast<std::int64_t>(use_duration_s(motor.nominal) / period_s);
  for (std::int64_t i = 0; i < periods; ++i) {
    const double time_s = static_cast<double>(i) * period_s;
    const bool is_on = use.on_s <= 0.0 || std::fmod(time_s, use.on_s + use.off_s) < use.on_s;
    const double speed_rad_per_s = (is_on ? use.speed_share : use.off_speed_share) * rules.most_speed_rad_per_s;
    double flowing_A = 0.0;
    double counted_A = 0.0;
    if (is_on) {
      counted_A = model_only.table.allowed_A(static_cast<float>(speed_rad_per_s), capped.hottest_body_C(),
                                             capped.state_C()[motor::states::winding]);
      const double cold_A = plan.table.allowed_A(speed_rad_per_s, rules.hottest_ambient_C, rules.hottest_ambient_C);
      flowing_A = std::min({rules.most_current_A, cold_A, counted_A + gain_A});
    }
    intervals.take(time_s, flowing_A, speed_rad_per_s, period_s);
    std::array<float, observed::kSignalCount> signals{};
    std::ranges::transform(use.hot_case.signals(rules, std::min(counted_A, flowing_A), speed_rad_per_s), signals.begin(),
                           [](double value) { return static_cast<float>(value); });
    capped.step(signals);
  }
  intervals.end(static_cast<double>(periods) * period_s);
  return result;
}

void set_sensor_fault(SensorPlan& plan, const motor::Motor& motor, const robot::Robot& robot, const Derating& model_only,
                      std::span<const LoadPattern> uses) {
  constexpr double kTolerance_A = 0.02;
  const TemperatureLimits& limits = model_only.rules.limits;
  const double cool_C = model_only.rules.hottest_ambient_C;
  double low_A = 0.0;
  double high_A = model_only.rules.most_current_A;
  while (high_A - low_A > kTolerance_A) {
    const double middle_A = 0.5 * (low_A + high_A);
    const NominalPeak peak = nominal_peak(motor, limits, play_all(plan, model_only, motor, robot, uses, middle_A, cool_C));
    (peak.is_over ? high_A : low_A) = middle_A;
  }
  plan.most_gain_A = low_A;
  const std::vector<UsePlayed> played = play_all(plan, model_only, motor, robot, uses, low_A, cool_C);
  plan.sensor_fault_nominal_C = nominal_peak(motor, limits, played).winding_C;
  plan.sensor_fault_over = check(motor, limits, played, model_only.options.guarantee, kSensorFaultStream).over;
  plan.sensor_fault_warm_C = plan.sensor_fault_nominal_C;
  constexpr int kStarts = 6;
  for (int i = 1; i <= kStarts; ++i) {
    const double start_C = std::lerp(cool_C, limits.winding_C, static_cast<double>(i) / kStarts);
    const double peak_C = nominal_peak(motor, limits, play_all(plan, model_only, motor, robot, uses, low_A, start_C)).winding_C;
    plan.sensor_fault_warm_C = std::max(plan.sensor_fault_warm_C, peak_C);
  }
}

}  // namespace heatsoak::derate
