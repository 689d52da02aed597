#include "motor/sensor_effect.h"

#include <algorithm>
#include <cmath>

#include "motor/sensors_registry.h"

namespace heatsoak::motor {
namespace {

constexpr double kGainReference_C = 25.0;

/// Share of an initial difference that remains after an interval.
double kept_of_lag(double lag_s, double duration_s) { return lag_s > 0.0 ? std::exp(-duration_s / lag_s) : 0.0; }

}  // namespace

const std::vector<SensorEffectType>& all_sensor_effects() {
  static const std::vector<SensorEffectType> all = [] {
    std::vector<SensorEffectType> list;
    for (const sensors::Entry& entry : sensors::registry) {
      list.push_back(entry.make());
      list.back().name = entry.name;
    }
    std::ranges::sort(list, {}, &SensorEffectType::name);
    return list;
  }();
  return all;
}

const SensorEffectType* find_sensor_effect(std::string_view name) {
  const auto found = std::ranges::find(all_sensor_effects(), name, &SensorEffectType::name);
  return found == all_sensor_effects().end() ? nullptr : &*found;
}

void SensorLaw::apply(std::span<const double> time_s, double size, bool is_change, std::span<double> shown_C) const {
  double before_C = shown_C[0];
  shown_C[0] = at_rest(size, before_C, is_change);
  for (std::size_t k = 0; k + 1 < time_s.size(); ++k) {
    const double now_C = shown_C[k + 1];
    shown_C[k + 1] = next_C(size, time_s[k + 1] - time_s[k], before_C, now_C, shown_C[k], is_change);
    before_C = now_C;
  }
}

void apply(std::span<const SensorFault> faults, std::span<const double> time_s, bool is_change, std::span<double> shown_C) {
  for (const SensorFault& fault : faults) {
    fault.type->law.apply(time_s, fault.size, is_change, shown_C);
  }
}

double sensor_at_rest_C(std::span<const SensorFault> faults, double true_C) {
  for (const SensorFault& fault : faults) {
    true_C = fault.type->law.at_rest(fault.size, true_C, false);
  }
  return true_C;
}

double true_at_rest_C(std::span<const SensorFault> faults, double sensor_C) {
  // Readings at rest are linear in the temperature.
  const double at_0_C = sensor_at_rest_C(faults, 0.0);
  return (sensor_C - at_0_C) / (sensor_at_rest_C(faults, 1.0) - at_0_C);
}

Reading::Reading(std::vector<SensorFault> faults, double true_C) : faults_(std::move(faults)), passed_C_{true_C} {
  for (const SensorFault& fault : faults_) {
    passed_C_.push_back(fault.type->law.at_rest(fault.size, passed_C_.back(), false));
  }
}

void Reading::advance(double duration_s, double true_C) {
  double now_C = true_C;
  for (std::size_t i = 0; i < faults_.size(); ++i) {
    const double sensor_C = faults_[i].type->law.next_C(faults_[i].size, duration_s, passed_C_[i], now_C, passed_C_[i + 1], false);
    passed_C_[i] = now_C;
    now_C = sensor_C;
  }
  passed_C_.back() = now_C;
}

SensorLaw sensor_offset_law() {
  return {
      .at_rest = [](double size, double true_C, bool is_change) { return is_change ? true_C : true_C + size; },
      .by_size = [](std::span<const double>, double, std::span<const double> true_C) { return std::vector<double>(true_C.size(), 1.0); }};
}

SensorLaw sensor_gain_law() {
  return {
      .at_rest = [](double size, double true_C, bool is_change) { return true_C + size * (true_C - (is_change ? 0.0 : kGainReference_C)); },
      .by_size =
          [](std::span<const double>, double, std::span<const double> true_C) {
            std::vector<double> derivative(true_C.begin(), true_C.end());
            std::ranges::for_each(derivative, [](double& each) { each -= kGainReference_C; });
            return derivative;
          }};
}

SensorLaw sensor_lag_law() {
  // Between two samples the temperature changes linearly with slope s; the reading follows y(t) = T(t) − τ·s + (y₀ − T₀ + τ·s)·e^(−t/τ).
  // Initially it equals the temperature.
  return {.at_rest = [](double, double true_C, bool) { return true_C; },
          .after =
              [](double size, double duration_s, double before_C, double now_C, double sensor_C) {
                if (!(duration_s > 0.0)) {
                  return sensor_C;
                }
                const double behind_K = size * (now_C - before_C) / duration_s;
                return now_C - behind_K + (sensor_C - before_C + behind_K) * kept_of_lag(size, duration_s);
              },
          .by_size =
              [](std::span<const double> time_s, double size, std::span<const double> true_C) {
                std::vector<double> derivative(true_C.size(), 0.0);
                double difference_K = 0.0;  // reading − temperature
                for (std::size_t k = 0; k + 1 < true_C.size(); ++k) {
                  const double duration_s = time_s[k + 1] - time_s[k];
                  const double kept = kept_of_lag(size, duration_s);
                  const double slope_K_per_s = (true_C[k + 1] - true_C[k]) / duration_s;
                  const double behind_K = size * slope_K_per_s;
                  const double kept_by_size_per_s = size > 0.0 ? kept * duration_s / (size * size) : 0.0;
                  derivative[k + 1] =
                      -slope_K_per_s + (derivative[k] + slope_K_per_s) * kept + (difference_K + behind_K) * kept_by_size_per_s;
                  difference_K = -behind_K + (difference_K + behind_K) * kept;
                }
                return derivative;
              }};
}

}  // namespace heatsoak::motor
