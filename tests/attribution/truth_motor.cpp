#include "truth_motor.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/unknown.h"

namespace heatsoak::attribution::truth {
namespace {

/// Shares of copper and iron. Parts of one material are so closely coupled that two nodes approximate all eight within 0.1 K.
constexpr PerPart kCopperShare{0.66, 0.17, 0.17};
constexpr PerPart kIronShare{0, 0, 0, 0.26, 0.38, 0.20, 0.08, 0.08};
struct Bridge {
  Part from, to;
  double conductance_W_per_K;
};
constexpr std::array kMetal{Bridge{slot, overhang_front, 60.0}, Bridge{slot, overhang_back, 60.0},  Bridge{tooth, yoke, 220.0},
                            Bridge{yoke, sleeve, 220.0},        Bridge{sleeve, shield_front, 60.0}, Bridge{sleeve, shield_back, 60.0}};

class Machine {
 public:
  Machine(const MotorMake& make, const Missing& missing) : make_(make), missing_(missing) {
    for (int p = 0; p < part_count; ++p) {
      capacity_[p] =
          kCopperShare[p] * make.copper_capacity_J_per_K + kIronShare[p] * make.iron_capacity_J_per_K + missing.lump_capacity_J_per_K[p];
    }
    steps_per_row_ = make.finer * std::max(20, static_cast<int>(std::ceil(fastest_per_s() / kStepTimesFastest)));
  }

  PerPart slope(const RowInputs& in, const PerPart& T, double time_s, double age_h, double copper_W, double iron_W) const {
    const double copper_C = 0.66 * T[slot] + 0.17 * (T[overhang_front] + T[overhang_back]);
    double iron_C = 0.0;
    for (int p = tooth; p <= shield_back; ++p) {
      iron_C += kIronShare[p] * T[p];
    }
    PerPart heat{};
    const double joule_W = in.current_A * in.current_A * make_.resistance_25C_ohm;
    double copper_loss_W = 0.0;
    for (int p = slot; p <= overhang_back; ++p) {
      const double part_W = joule_W * kCopperShare[p] * (1.0 + make_.copper_per_K * (T[p] - 25.0));
      copper_loss_W += part_W;
      heat[p] += part_W + copper_W * kCopperShare[p];
    }
    for (int p = tooth; p <= shield_back; ++p) {
      heat[p] += iron_W * kIronShare[p];
    }
    const auto conduct = [&](int a, int b, double conductance_W_per_K) {
      const double flow_W = conductance_W_per_K * (T[a] - T[b]);
      heat[a] -= flow_W;
      heat[b] += flow_W;
    };
    for (const Bridge& b : kMetal) {
      conduct(b.from, b.to, make_.metal_ratio * b.conductance_W_per_K);
    }
    conduct(slot, tooth, 0.7 / make_.copper_to_iron_K_per_W);
    conduct(slot, yoke, 0.3 / make_.copper_to_iron_K_per_W);
    heat[sleeve] -= 0.6 / make_.iron_to_air_K_per_W * (T[sleeve] - in.ambient_C);
    heat[shield_front] -= 0.2 / make_.iron_to_air_K_per_W * (T[shield_front] - in.ambient_C);
    heat[shield_back] -= 0.2 / make_.iron_to_air_K_per_W * (T[shield_back] - in.ambient_C);
    const Moment now{in, T, copper_loss_W, time_s, age_h, copper_C, iron_C};
    for (const Heat& each : missing_.heat) {
      each(now, heat);
    }
    for (int p = 0; p < part_count; ++p) {
      heat[p] = capacity_[p] > 0.0 ? heat[p] / capacity_[p] : 0.0;
    }
    return heat;
  }

  void advance(const RowInputs& in, PerPart& T, double time_s, double age_h, double copper_W, double iron_W) const {
    const double h_s = 1.0 / steps_per_row_;
    const auto shifted = [](const PerPart& a, const PerPart& b, double factor) {
      PerPart sum = a;
      for (int p = 0; p < part_count; ++p) {
        sum[p] += factor * b[p];
      }
      return sum;
    };
    for (int i = 0; i < steps_per_row_; ++i, time_s += h_s, age_h += h_s / 3600.0) {
      const PerPart a = slope(in, T, time_s, age_h, copper_W, iron_W);
      const PerPart b = slope(in, shifted(T, a, h_s / 2), time_s + h_s / 2, age_h, copper_W, iron_W);
      const PerPart c = slope(in, shifted(T, b, h_s / 2), time_s + h_s / 2, age_h, copper_W, iron_W);
      const PerPart d = slope(in, shifted(T, c, h_s), time_s + h_s, age_h, copper_W, iron_W);
      for (int p = 0; p < part_count; ++p) {
        T[p] += h_s / 6.0 * (a[p] + 2.0 * b[p] + 2.0 * c[p] + d[p]);
      }
    }
  }

 private:
  /// Gershgorin bound of the eigenvalues. The method is stable for steps up to 2.78 divided by it; half of that gives a relative error of
  /// 1e-4.
  [[nodiscard]] double fastest_per_s() const {
    PerPart conductance_W_per_K{};
    const auto add = [&](int a, int b, double each_W_per_K) {
      conductance_W_per_K[a] += each_W_per_K;
      conductance_W_per_K[b] += each_W_per_K;
    };
    for (const Bridge& b : kMetal) {
      add(b.from, b.to, make_.metal_ratio * b.conductance_W_per_K);
    }
    add(slot, tooth, 1.0 / make_.copper_to_iron_K_per_W);
    add(slot, yoke, 1.0 / make_.copper_to_iron_K_per_W);
    add(sleeve, shield_front, 1.0 / make_.iron_to_air_K_per_W);
    add(sleeve, shield_back, 1.0 / make_.iron_to_air_K_per_W);
    double fastest_per_s = 0.0;
    for (int p = 0; p < part_count; ++p) {
      fastest_per_s = std::max(fastest_per_s, capacity_[p] > 0.0 ? 2.0 * conductance_W_per_K[p] / capacity_[p] : 0.0);
    }
    return fastest_per_s;
  }

  static constexpr double kStepTimesFastest = 1.4;

  MotorMake make_;
  const Missing& missing_;
  PerPart capacity_{};
  int steps_per_row_ = 20;
};

/// Sensor with its fault, noise, resolution, and occasional wrong samples.
class Sensor {
 public:
  Sensor(const Surprise& surprise, double offset_K, double gain_ratio, double lag_s, double start_C)
      : surprise_(surprise), offset_K_(offset_K), gain_ratio_(gain_ratio), lag_s_(lag_s), felt_C_(start_C), last_C_(start_C) {}

  double read(double true_C, Dice& dice) {
    feel(true_C);
    double sensor_C = 25.0 + gain_ratio_ * (felt_C_ - 25.0) + offset_K_ + drift_K_ + surprise_.noise_K * dice.normal();
    if (surprise_.drift_K > 0.0) {
      const double kept = std::exp(-1.0 / surprise_.drift_time_s);
      drift_K_ = kept * drift_K_ + surprise_.drift_K * std::sqrt(1.0 - kept * kept) * dice.normal();
    }
    sensor_C += dice.uniform(0.0, 1.0) < surprise_.outlier_probability ? 8.0 * dice.normal() : 0.0;
    gap_rows_ = gap_rows_ > 0 ? gap_rows_ - 1 : dice.uniform(0.0, 1.0) < surprise_.gap_probability ? 30 : 0;
    const double stepped_C = surprise_.step_K > 0.0 ? std::round(sensor_C / surprise_.step_K) * surprise_.step_K : sensor_C;
    return gap_rows_ > 0 ? base::kUnknown : stepped_C;
  }

 private:
  /// Integrates the sensor's equation over the last second in small steps, with linear interpolation of the temperature.
  void feel(double true_C) {
    constexpr int kSteps = 100;
    for (int i = 0; i < kSteps && lag_s_ > 0.0; ++i) {
      const double near_C = last_C_ + (true_C - last_C_) * (i + 0.5) / kSteps;
      felt_C_ += (near_C - felt_C_) / (lag_s_ * kSteps);
    }
    felt_C_ = lag_s_ > 0.0 ? felt_C_ : true_C;
    last_C_ = true_C;
  }

  const Surprise& surprise_;
  double offset_K_, gain_ratio_, lag_s_, felt_C_, last_C_;
  double drift_K_ = 0.0;
  int gap_rows_ = 0;
};

}  // namespace

double Dice::normal() {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform(0.0, 1.0)));
  return radius * std::cos(2.0 * std::numbers::pi * uniform(0.0, 1.0));
}

TrueRun run_motor(const MotorMake& make, const Missing& missing, const Surprise& surprise, const std::vector<RowInputs>& rows, double age_h,
                  std::uint64_t seed, const std::string& name) {
  Dice dice(seed);
  const Machine machine(make, missing);
  PerPart T;
  T.fill(rows.front().ambient_C + dice.uniform(0.0, 6.0));
  const double warmer_K = dice.uniform(0.0, 5.0);
  for (int p = slot; p <= overhang_back; ++p) {
    T[p] += warmer_K;
  }
  T[lump_a] = T[lump_b] = rows.front().ambient_C;
  double copper_W = surprise.flux_W * dice.normal();
  double iron_W = surprise.flux_W * dice.normal();
  const double kept = std::exp(-1.0 / surprise.flux_time_s);
  const double fresh_W = surprise.flux_W * std::sqrt(1.0 - kept * kept);
  const SensorFault& fault = missing.sensors;
  Sensor winding(surprise, fault.winding_offset_K, fault.winding_gain_ratio, fault.winding_lag_s, T[overhang_front]);
  Sensor stator(surprise, fault.stator_offset_K, 1.0, fault.stator_lag_s, T[sleeve]);
  TrueRun run;
  run.log.name = name;
  run.log.run_begins = {0};
  const auto channel = [&](const char* key) -> std::size_t {
    run.log.channels.push_back({*recording::quantity_named(key), {}});
    return run.log.channels.size() - 1;
  };
  const std::size_t winding_at = channel("winding_C"), stator_at = channel("stator_C"), ambient_at = channel("ambient_C");
  const std::size_t current_at = channel("current_A"), speed_at = channel("speed_rad_per_s"), bus_at = channel("bus_V");
  const std::size_t duty_at = channel("modulation_ratio"), vehicle_at = channel("vehicle_speed_m_per_s"),
                    neighbour_at = channel("neighbour_C");
  const std::size_t torque_at = channel("torque_Nm");
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const RowInputs& in = rows[k];
    const auto time_s = static_cast<double>(k);
    run.winding_C.push_back(T[overhang_front]);
    run.stator_C.push_back(T[sleeve]);
    run.log.time_s.push_back(time_s);
    run.log.line.push_back(static_cast<int>(k) + 2);
    const auto put = [&](std::size_t at, double value) { run.log.channels[at].values.push_back(value); };
    put(winding_at, winding.read(T[overhang_front], dice));
    put(stator_at, stator.read(T[sleeve], dice));
    put(ambient_at, in.ambient_C);
    put(current_at, in.current_A);
    put(speed_at, in.speed_rad_per_s);
    put(bus_at, in.bus_V);
    put(duty_at, in.duty_ratio);
    put(vehicle_at, in.vehicle_speed_m_per_s);
    put(neighbour_at, in.neighbour_C);
    put(torque_at, 0.034 * in.current_A);
    machine.advance(in, T, time_s, age_h + time_s / 3600.0, copper_W, iron_W);
    copper_W = kept * copper_W + fresh_W * dice.normal();
    iron_W = kept * iron_W + fresh_W * dice.normal();
  }
  return run;
}

}  // namespace heatsoak::attribution::truth
