#include "recording/noise.h"

#include <algorithm>
#include <boost/math/statistics/univariate_statistics.hpp>
#include <cmath>

namespace heatsoak::recording {
namespace {

constexpr double kMedianToSigma = 1.4826;
constexpr std::size_t kLongRest = 20;  // more equal samples may be a frozen sensor, which says nothing about noise

std::vector<double> sorted_of(std::vector<double> values) {
  std::ranges::sort(values);
  return values;
}

struct Level {
  double value = 0.0;
  std::size_t count = 0;
};

/// Distinct values with their counts. If most values recur, those that occur once are dropped as bad samples.
std::vector<Level> levels_of(const std::vector<double>& sorted) {
  std::vector<Level> levels;
  for (const double value : sorted) {
    if (levels.empty() || value - levels.back().value > 1e-9 * std::max(std::abs(value), std::abs(levels.back().value))) {
      levels.push_back({value, 0});
    }
    ++levels.back().count;
  }
  const auto single = static_cast<std::size_t>(std::ranges::count_if(levels, [](const Level& level) { return level.count == 1; }));
  if (2 * single < sorted.size()) {
    std::erase_if(levels, [](const Level& level) { return level.count == 1; });
  }
  return levels;
}

double resolution_of_sorted(const std::vector<double>& sorted) {
  const std::vector<Level> levels = levels_of(sorted);
  std::vector<double> apart;
  for (std::size_t i = 1; i < levels.size(); ++i) {
    apart.push_back(levels[i].value - levels[i - 1].value);
  }
  if (apart.empty()) {
    return 0.0;
  }
  const double smallest = std::ranges::min(apart);
  constexpr double kFinestGrid_share = 1e-6;  // share of the range; a finer grid comes from the number of stored digits
  constexpr double kOffGrid_share = 0.1;
  constexpr double kOnGrid_share = 0.95;
  const auto on_grid = std::ranges::count_if(apart, [smallest](double difference) {
    const double multiple = difference / smallest;
    return std::abs(multiple - std::round(multiple)) < kOffGrid_share;
  });
  if (apart.size() >= 3 && smallest > kFinestGrid_share * (levels.back().value - levels.front().value) &&
      static_cast<double>(on_grid) >= kOnGrid_share * static_cast<double>(apart.size())) {
    return smallest;
  }
  return levels.size() * 5 < sorted.size() ? median_of(std::move(apart)) : 0.0;
}

}  // namespace

double median_of(std::vector<double> values) { return values.empty() ? 0.0 : boost::math::statistics::median(values); }

double resolution_of(std::span<const double> values) {
  Thinned some;
  for (const double value : values) {
    if (!std::isnan(value)) {
      some.add(value);
    }
  }
  return resolution_of_sorted(sorted_of(some.values()));
}

void NoiseGauge::add(std::span<const double> values) {
  for (const double value : values) {
    if (!std::isnan(value)) {
      values_.add(value);
    }
    const double change = value - value_;
    equal_ = change == 0.0 ? equal_ + 1 : 0;
    if (!std::isnan(change)) {
      changes_.add(std::abs(change));
      const double bend = change - (value_ - before_);
      if (!std::isnan(bend) && equal_ < kLongRest) {
        bends_.add(std::abs(bend));
      }
    }
    before_ = value_;
    value_ = value;
  }
}

NoiseLevel NoiseGauge::level() const {
  NoiseLevel level;
  std::vector<double> sorted = sorted_of(values_.values());
  level.step = resolution_of_sorted(sorted);
  level.distinct = static_cast<std::size_t>(std::unique(sorted.begin(), sorted.end()) - sorted.begin());
  std::vector<double> changes = changes_.values();
  const auto pairs = static_cast<double>(changes.size());
  std::erase(changes, 0.0);
  level.repeats_share = pairs > 0.0 ? 1.0 - static_cast<double>(changes.size()) / pairs : 0.0;
  level.usual = median_of(std::move(changes));
  level.noise = std::max(kMedianToSigma * median_of(bends_.values()) / std::sqrt(6.0), level.step / std::sqrt(12.0));
  return level;
}

NoiseLevel noise_level(std::span<const double> values, std::span<const std::pair<std::size_t, std::size_t>> runs, std::size_t most) {
  NoiseGauge gauge(most);
  for (const auto& [begin, end] : runs) {
    gauge.begin_run();
    gauge.add(values.subspan(begin, end - begin));
  }
  return gauge.level();
}

}  // namespace heatsoak::recording
