// A motor with a sensor in the loop of its generated guard. The plant is the network of a drawn motor with a separate integrator.
#pragma once

#include <algorithm>
#include <functional>
#include <random>
#include <vector>

#include "compiled_guard.h"
#include "guarded_motor.h"
#include "robot/motor_drive.h"

namespace heatsoak::derate {

/// Options with few motors for the search. Other motors then check the guarantee.
inline DerateOptions quick_options(const SensorOptions& sensor) {
  DerateOptions options;
  options.guarantee.samples = 120;
  options.sensor = sensor;
  return options;
}
inline const Derating& thermistor_derating() {
  static const Derating derating = derate(ecx_32(), twente(), quick_options({}));
  return derating;
}
inline const Derating& resistance_derating() {
  static const Derating derating = derate(
      ecx_32(), twente(), quick_options({.kind = SensorKind::winding_resistance, .node = motor::states::winding, .accuracy_K = 10.0}));
  return derating;
}

/// Euler steps of the true network. Its time constants are hundreds of times the period.
class Plant {
 public:
  Plant(const motor::Motor& motor, const motor::MotorSample& sample, double start_C)
      : nominal_(motor.nominal),
        network_(motor::datasheet_network(motor, sample)),
        values_(network_.values()),
        true_C_(network_.node_count(), start_C),
        rate_(network_.state_count()) {}

  void step(double current_A, double speed_rad_per_s, double ambient_C, double period_s) {
    const Signals signals{current_A, speed_rad_per_s, ambient_C, 0.0, ambient_C, 0.0, 0.0};
    const thermal::OperatingPoint<double> at = operating_point<double>(nominal_, robot_, signals);
    network_.rate_K_per_s<double>(at, values_, true_C_, rate_);
    for (std::size_t node = 0; node < rate_.size(); ++node) {
      true_C_[node] += period_s * rate_[node];
    }
  }
  [[nodiscard]] double true_C(int node) const { return true_C_[static_cast<std::size_t>(node)]; }

 private:
  robot::Robot robot_ = twente();
  motor::MotorValues nominal_;
  thermal::Network network_;
  std::vector<double> values_;
  std::vector<double> true_C_;
  std::vector<double> rate_;
};

/// Sensor reading as a function of time and of the true stator temperature.
using Sensor = std::function<float(double time_s, double true_C, double ambient_C)>;

struct SensedRun {
  double winding_peak_C = 0.0;
  /// Excess over an independent guard without a sensor. The input of that guard is the same current, limited by its own allowance.
  double most_excess_A = -1e9;
  double dropped_at_s = -1.0;
  int status = 0;
  double last_allowed_A = 0.0;
};

/// Current of a driver that differs from the asked one.
struct CurrentError {
  double over_share = 0.0;    ///< always this share more
  double ripple_share = 0.0;  ///< every other period this share more, else this share less
};

/// Drives with the full allowed current, or with a random load.
inline SensedRun run_sensed(const CompiledGuard& guard, const Derating& derating, Plant& plant, const Sensor& sensor, int steps,
                            unsigned driver_seed, bool is_always_all = false, const CurrentError& error = {}) {
  SensedGuard sensed(guard);
  ModelGuard model(guard);
  const double ambient_C = 39.5;  // just below 40 °C, the value that replaces a missing measurement
  sensed.start(static_cast<float>(ambient_C));
  model.start(static_cast<float>(ambient_C));
  SensedRun run;
  RandomLoad driver(driver_seed);
  const double period_s = derating.options.period_s;
  double allowed_A = 0.0;
  double capped_A = 0.0;
  for (int i = 0; i < steps; ++i) {
    const RandomLoad::Wish wish = is_always_all ? RandomLoad::Wish{} : driver.after(period_s);
    const double ripple_share = i % 2 == 0 ? error.ripple_share : -error.ripple_share;
    const double current_A = wish.current_share * allowed_A * (1.0 + error.over_share + ripple_share);
    const double speed_rad_per_s = wish.speed_share * derating.rules.most_speed_rad_per_s;
    plant.step(current_A, speed_rad_per_s, ambient_C, period_s);
    run.winding_peak_C = std::max(run.winding_peak_C, plant.true_C(motor::states::winding));
    CompiledGuard::Input in{static_cast<float>(current_A), static_cast<float>(speed_rad_per_s), static_cast<float>(ambient_C)};
    const CompiledGuard::Output out = sensed.step(in, sensor(i * period_s, plant.true_C(motor::states::stator), ambient_C));
    in.current_A = std::clamp(in.current_A, -static_cast<float>(capped_A), static_cast<float>(capped_A));
    capped_A = model.step(in).allowed_A;
    run.most_excess_A = std::max(run.most_excess_A, out.allowed_A - capped_A);
    allowed_A = out.allowed_A;
    run.status = out.sensor;
    const bool is_dropped = out.sensor == CompiledGuard::too_cold || out.sensor == CompiledGuard::frozen;
    run.dropped_at_s = run.dropped_at_s < 0.0 && is_dropped ? i * period_s : run.dropped_at_s;
  }
  run.last_allowed_A = allowed_A;
  return run;
}

}  // namespace heatsoak::derate
