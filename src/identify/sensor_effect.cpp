#include "identify/sensor_effect.h"

#include <algorithm>
#include <cmath>

#include "identify/sensors_registry.h"

namespace heatsoak {
namespace {

constexpr double kGainReference_C = 25.0;

/// Calls step(k, rise, duration_s, kept) for each interval; `kept` is what remains of a difference after it.
template <class Step>
void through(std::span<const double> time_s, double lag_s, const Step& step) {
  for (std::size_t k = 0; k + 1 < time_s.size(); ++k) {
    const double duration_s = time_s[k + 1] - time_s[k];
    step(static_cast<Eigen::Index>(k), duration_s, lag_s > 0.0 ? std::exp(-duration_s / lag_s) : 0.0);
  }
}

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

SensorLaw sensor_offset_law() {
  return {.apply =
              [](std::span<const double>, double size, bool is_change, Eigen::Ref<Eigen::VectorXd> shown) {
                shown.array() += is_change ? 0.0 : size;
              },
          .by_size = [](std::span<const double>, double, const Eigen::VectorXd& true_C) -> Eigen::VectorXd {
            return Eigen::VectorXd::Ones(true_C.size());
          }};
}

SensorLaw sensor_gain_law() {
  return {.apply =
              [](std::span<const double>, double size, bool is_change, Eigen::Ref<Eigen::VectorXd> shown) {
                const double reference_C = is_change ? 0.0 : kGainReference_C;
                shown.array() += size * (shown.array() - reference_C);
              },
          .by_size = [](std::span<const double>, double, const Eigen::VectorXd& true_C) -> Eigen::VectorXd {
            return true_C.array() - kGainReference_C;
          }};
}

SensorLaw sensor_lag_law() {
  // Between two samples the temperature changes evenly with slope s; the reading then follows
  // y(t) = T(t) − τ·s + (y₀ − T₀ + τ·s)·e^(−t/τ). It starts at the temperature itself.
  return {.apply =
              [](std::span<const double> time_s, double size, bool, Eigen::Ref<Eigen::VectorXd> shown) {
                const Eigen::VectorXd true_C = shown;
                through(time_s, size, [&](Eigen::Index k, double duration_s, double kept) {
                  const double behind_K = size * (true_C[k + 1] - true_C[k]) / duration_s;
                  shown[k + 1] = true_C[k + 1] - behind_K + (shown[k] - true_C[k] + behind_K) * kept;
                });
              },
          .by_size = [](std::span<const double> time_s, double size, const Eigen::VectorXd& true_C) -> Eigen::VectorXd {
            Eigen::VectorXd derivative = Eigen::VectorXd::Zero(true_C.size());
            double difference_K = 0.0;  // reading − temperature
            through(time_s, size, [&](Eigen::Index k, double duration_s, double kept) {
              const double slope_K_per_s = (true_C[k + 1] - true_C[k]) / duration_s;
              const double behind_K = size * slope_K_per_s;
              const double kept_by_size_per_s = size > 0.0 ? kept * duration_s / (size * size) : 0.0;
              derivative[k + 1] = -slope_K_per_s + (derivative[k] + slope_K_per_s) * kept + (difference_K + behind_K) * kept_by_size_per_s;
              difference_K = -behind_K + (difference_K + behind_K) * kept;
            });
            return derivative;
          }};
}

}  // namespace heatsoak
