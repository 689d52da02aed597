#include "derate/sensed/closed_loop.h"

#include <algorithm>
#include <cmath>

#include "robot/motor_drive.h"
#include "thermal/ensemble.h"

namespace heatsoak::derate {
namespace {

using LaneSignals = std::array<thermal::Lanes, observed::kSignalCount>;
using LaneFlags = std::array<bool, base::kLanes>;

/// Rates of an observer for kLanes motors at once.
class LaneObserver {
 public:
  LaneObserver(const Observer& observer, std::span<const int> rate_steps)
      : rates_(observer.formula(), rate_steps), inputs_(observed::kSignalCount + observer.state_count()), rate_(observer.state_count()) {}

  const std::vector<thermal::Lanes>& rates_K_per_s(const LaneSignals& signals, const std::vector<thermal::Lanes>& state_C) {
    std::ranges::copy(signals, inputs_.begin());
    std::ranges::copy(state_C, inputs_.begin() + observed::kSignalCount);
    rates_.run(inputs_, rate_);
    return rate_;
  }

 private:
  thermal::FormulaRun<thermal::Lanes> rates_;
  std::vector<thermal::Lanes> inputs_;
  std::vector<thermal::Lanes> rate_;
};

/// The guards of kLanes motors: the estimated state of each, and whether its sensor is trusted.
class LaneGuard {
 public:
  explicit LaneGuard(const SensedLoop& loop)
      : loop_(loop),
        sensed_(loop.plan.observer, loop.plan.observer.rate_steps()),
        model_only_(loop.model_only, loop.model_only.rate_steps()) {}

  void start(double temperature_C) {
    state_C_.assign(loop_.model_only.state_count(), thermal::Lanes::Constant(temperature_C));
    lag_C_ = thermal::Lanes::Constant(temperature_C);
    unread_s_.fill(0.0);
  }

  [[nodiscard]] thermal::Lanes allowed_A(double speed_rad_per_s) const {
    thermal::Lanes allowed;
    for (int lane = 0; lane < base::kLanes; ++lane) {
      double body_C = state_C_[motor::states::stator][lane];
      for (std::size_t node = motor::states::first_own; node < state_C_.size(); ++node) {
        body_C = std::max(body_C, state_C_[node][lane]);
      }
      const CurrentTable& table = is_trusted(lane) ? loop_.plan.table : loop_.table;
      allowed[lane] = table.allowed_A(speed_rad_per_s, body_C, state_C_[motor::states::winding][lane]);
    }
    return allowed;
  }

  void heat(const LaneSignals& signals) {
    const std::vector<thermal::Lanes>& low = sensed_.rates_K_per_s(signals, state_C_);
    const bool all_trusted = std::ranges::all_of(unread_s_, [&](double unread_s) { return unread_s < loop_.plan.check.hold_s; });
    if (all_trusted) {
      for (std::size_t node = 0; node < state_C_.size(); ++node) {
        state_C_[node] += loop_.step_s * low[node];
      }
    } else {
      const std::vector<thermal::Lanes>& high = model_only_.rates_K_per_s(signals, state_C_);
      for (std::size_t node = 0; node < state_C_.size(); ++node) {
        for (int lane = 0; lane < base::kLanes; ++lane) {
          state_C_[node][lane] += loop_.step_s * (is_trusted(lane) ? low[node][lane] : high[node][lane]);
        }
      }
    }
    if (loop_.plan.options.lag_s > 0.0) {
      lag_C_ += loop_.step_s / loop_.plan.options.lag_s * (state_C_[static_cast<std::size_t>(loop_.plan.options.node)] - lag_C_);
    }
  }

  /// Corrects the state by the innovation in lanes with a reading.
  void correct(const thermal::Lanes& reading_C, const LaneFlags& is_read) {
    const SensorPlan& plan = loop_.plan;
    const double steps = loop_.step_s / loop_.period_s;
    const bool lags = plan.options.lag_s > 0.0;
    const thermal::Lanes predicted_C = lags ? lag_C_ : state_C_[static_cast<std::size_t>(plan.options.node)];
    thermal::Lanes innovation_K = reading_C + plan.options.accuracy_K - predicted_C;
    for (int lane = 0; lane < base::kLanes; ++lane) {
      const auto place = static_cast<std::size_t>(lane);
      innovation_K[lane] = is_read[place] ? innovation_K[lane] : 0.0;
      unread_s_[place] = is_read[place] ? 0.0 : unread_s_[place] + loop_.step_s;
    }
    for (std::size_t node = 0; node < state_C_.size(); ++node) {
      state_C_[node] += std::min(1.0, steps * plan.gain[node]) * innovation_K;
    }
    lag_C_ += std::min(1.0, steps * plan.lag_gain_ratio) * innovation_K;
  }

 private:
  [[nodiscard]] bool is_trusted(int lane) const { return unread_s_[static_cast<std::size_t>(lane)] < loop_.plan.check.hold_s; }

  const SensedLoop& loop_;
  LaneObserver sensed_;
  LaneObserver model_only_;
  std::vector<thermal::Lanes> state_C_;
  thermal::Lanes lag_C_;
  std::array<double, base::kLanes> unread_s_{};
};

/// Records the extremes that correct sensors show, from which the bounds of the cross-check are derived.
class Bounds {
 public:
  Bounds(const SensedLoop& loop, std::array<SensedPeak, base::kLanes>& peaks)
      : loop_(loop), nominal_(loop.model_only, loop.model_only.nominal_rate_steps()), peaks_(peaks) {}

  void start(double temperature_C) {
    nominal_C_.assign(loop_.model_only.state_count(), thermal::Lanes::Constant(temperature_C));
    reference_C_ = nominal_reference_C_ = last_C_ = thermal::Lanes::Constant(temperature_C);
  }

  void take(const LaneSignals& signals, const thermal::Lanes& true_C) {
    const std::vector<thermal::Lanes>& rate = nominal_.rates_K_per_s(signals, nominal_C_);
    for (std::size_t node = 0; node < nominal_C_.size(); ++node) {
      nominal_C_[node] += loop_.step_s * rate[node];
    }
    const thermal::Lanes& nominal_node_C = nominal_C_[static_cast<std::size_t>(loop_.plan.options.node)];
    const double air_C = loop_.rules.hottest_ambient_C;
    for (int lane = 0; lane < base::kLanes; ++lane) {
      SensedPeak& peak = peaks_[static_cast<std::size_t>(lane)];
      const double rise_K = true_C[lane] + loop_.plan.check.cold_margin_K - air_C;
      peak.cold_share = std::min(peak.cold_share, rise_K / std::max(1.0, nominal_node_C[lane] - air_C));
      peak.rate_K_per_s = std::max(peak.rate_K_per_s, std::abs(true_C[lane] - last_C_[lane]) / loop_.step_s);
      if (std::abs(true_C[lane] - reference_C_[lane]) > loop_.plan.check.frozen_band_K) {
        reference_C_[lane] = true_C[lane];
        nominal_reference_C_[lane] = nominal_node_C[lane];
      }
      peak.frozen_K = std::max(peak.frozen_K, std::abs(nominal_node_C[lane] - nominal_reference_C_[lane]));
    }
    last_C_ = true_C;
  }

 private:
  const SensedLoop& loop_;
  LaneObserver nominal_;
  std::array<SensedPeak, base::kLanes>& peaks_;
  std::vector<thermal::Lanes> nominal_C_;
  thermal::Lanes reference_C_;
  thermal::Lanes nominal_reference_C_;
  thermal::Lanes last_C_;
};

/// kLanes sensors with a constant error.
class LaneSensor {
 public:
  LaneSensor(const SensedLoop& loop, double error_K) : loop_(loop), error_K_(error_K) {}

  void start(double temperature_C) { sensor_C_ = thermal::Lanes::Constant(temperature_C); }

  /// Sensor temperature in °C without the error.
  [[nodiscard]] const thermal::Lanes& sensor_C() const { return sensor_C_; }

  thermal::Lanes reading_C(const thermal::Lanes& true_C) {
    const double lag_s = loop_.plan.options.lag_s;
    sensor_C_ = lag_s > 0.0 ? thermal::Lanes(sensor_C_ + std::min(1.0, loop_.step_s / lag_s) * (true_C - sensor_C_)) : true_C;
    return sensor_C_ + error_K_;
  }

 private:
  const SensedLoop& loop_;
  double error_K_;
  thermal::Lanes sensor_C_;
};

LaneSignals lane_signals(const HotCase& hot_case, const BarrierRules& rules, const thermal::Lanes& current_A, double speed_rad_per_s) {
  const Signals others = hot_case.signals(rules, 0.0, speed_rad_per_s);
  LaneSignals signals;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    signals[i] = thermal::Lanes::Constant(others[i]);
  }
  signals[observed::current] = hot_case.current_sign * current_A;
  return signals;
}

LaneFlags readable(const SensedLoop& loop, const thermal::Lanes& current_A, double speed_rad_per_s) {
  LaneFlags flags;
  for (int lane = 0; lane < base::kLanes; ++lane) {
    flags[static_cast<std::size_t>(lane)] = !loop.plan.resistance || loop.plan.resistance->is_usable(current_A[lane], speed_rad_per_s);
  }
  return flags;
}

/// Networks of the drawn motors, one per lane.
struct DrawnMotors {
  std::vector<thermal::Network> networks;
  std::vector<thermal::Lanes> parameters;
};

DrawnMotors side_by_side(const motor::Motor& motor, const std::array<motor::MotorSample, base::kLanes>& samples) {
  DrawnMotors drawn;
  for (int lane = 0; lane < base::kLanes; ++lane) {
    drawn.networks.push_back(motor::datasheet_network(motor, samples[static_cast<std::size_t>(lane)]));
    const std::vector<double> values = drawn.networks.back().values();
    drawn.parameters.resize(values.size());
    for (std::size_t p = 0; p < values.size(); ++p) {
      drawn.parameters[p][lane] = values[p];
    }
  }
  return drawn;
}

DrawnMotors drawn_motors(const motor::Motor& motor, std::uint64_t seed, std::uint64_t first_stream) {
  std::array<motor::MotorSample, base::kLanes> samples;
  for (int lane = 0; lane < base::kLanes; ++lane) {
    base::Random random(seed, first_stream + static_cast<std::uint64_t>(lane));
    samples[static_cast<std::size_t>(lane)] = motor::draw_sample(motor, random);
  }
  return side_by_side(motor, samples);
}

/// Returns the currents of the last step.
thermal::Lanes run_use(const SensedLoop& loop, const LoadPattern& use, const DrawnMotors& drawn, LaneGuard& guard, LaneSensor& sensor,
                       Bounds& bounds, std::array<SensedPeak, base::kLanes>& peaks) {
  const BarrierRules& rules = loop.rules;
  const double start_C = rules.hottest_ambient_C;
  const std::vector<thermal::Lanes> start(static_cast<std::size_t>(drawn.networks.front().state_count()),
                                          thermal::Lanes::Constant(start_C));
  thermal::EnsembleRun plant(drawn.networks.front(), drawn.parameters, start);
  guard.start(start_C);
  sensor.start(start_C);
  bounds.start(start_C);
  double longest_s = 0.0;
  thermal::Lanes last_A = thermal::Lanes::Zero();
  const auto steps = static_cast<int>(use_duration_s(loop.motor.nominal) / loop.step_s);
  for (int i = 0; i < steps; ++i) {
    const bool is_on = use.on_s <= 0.0 || std::fmod(i * loop.step_s, use.on_s + use.off_s) < use.on_s;
    const double speed_rad_per_s = (is_on ? use.speed_share : use.off_speed_share) * rules.most_speed_rad_per_s;
    const thermal::Lanes current_A = is_on ? guard.allowed_A(speed_rad_per_s) : thermal::Lanes(thermal::Lanes::Zero());
    last_A = current_A;
    const LaneSignals signals = lane_signals(use.hot_case, rules, current_A, speed_rad_per_s);
    thermal::OperatingPoint<thermal::Lanes> at = operating_point<thermal::Lanes>(loop.motor.nominal, loop.robot, signals);
    if (longest_s == 0.0) {
      longest_s = thermal::longest_step_s(drawn.networks.front(), drawn.parameters, at, rules.limits.winding_C - start_C);
    }
    plant.over(loop.step_s, at, longest_s);
    guard.heat(signals);
    const thermal::Lanes& true_C = plant.state_C()[static_cast<std::size_t>(loop.plan.options.node)];
    guard.correct(sensor.reading_C(true_C), readable(loop, current_A, speed_rad_per_s));
    bounds.take(signals, sensor.sensor_C());
  }
  for (int lane = 0; lane < base::kLanes; ++lane) {
    SensedPeak& peak = peaks[static_cast<std::size_t>(lane)];
    const double winding_C = plant.peak_C()[motor::states::winding][lane];
    peak.winding_C = std::max(peak.winding_C, winding_C);
    peak.is_over = peak.is_over || winding_C > rules.limits.winding_C ||
                   (rules.limits.stator_C && plant.peak_C()[motor::states::stator][lane] > *rules.limits.stator_C);
  }
  return last_A;
}

}  // namespace

std::array<SensedPeak, base::kLanes> sensed_peaks(const SensedLoop& loop, std::span<const LoadPattern> uses, std::uint64_t seed,
                                                  std::uint64_t first_stream) {
  const DrawnMotors drawn = drawn_motors(loop.motor, seed, first_stream);
  std::array<SensedPeak, base::kLanes> peaks{};
  LaneGuard guard(loop);
  LaneSensor sensor(loop, -loop.plan.options.accuracy_K);
  Bounds bounds(loop, peaks);
  for (const LoadPattern& use : uses) {
    run_use(loop, use, drawn, guard, sensor, bounds, peaks);
  }
  return peaks;
}

double nominal_lasting_current_A(const SensedLoop& loop, const LoadPattern& held) {
  std::array<motor::MotorSample, base::kLanes> samples;
  samples.fill(motor::nominal_sample(loop.motor));
  const DrawnMotors nominal = side_by_side(loop.motor, samples);
  std::array<SensedPeak, base::kLanes> peaks{};
  LaneGuard guard(loop);
  LaneSensor sensor(loop, 0.0);
  Bounds bounds(loop, peaks);
  return run_use(loop, held, nominal, guard, sensor, bounds, peaks)[0];
}

}  // namespace heatsoak::derate
