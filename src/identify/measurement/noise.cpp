#include "identify/measurement/noise.h"

#include <algorithm>
#include <boost/math/statistics/univariate_statistics.hpp>
#include <cmath>

namespace heatsoak {
namespace {

constexpr std::size_t kMostValues = 200'000;  ///< that are looked at, spread over the log
constexpr double kMedianToSigma = 1.4826;

/// Sorted, without NaN, of a long log some spread evenly.
std::vector<double> sorted_sample(std::span<const double> values) {
  std::vector<double> sorted;
  for (std::size_t i = 0; i < values.size(); i += values.size() / kMostValues + 1) {
    if (!std::isnan(values[i])) {
      sorted.push_back(values[i]);
    }
  }
  std::ranges::sort(sorted);
  return sorted;
}

struct Level {
  double value = 0.0;
  std::size_t count = 0;
};

/// Values and how often each comes; where most come again, the others are no steps of the sensor but bad samples.
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

}  // namespace

double resolution_of(std::span<const double> values) {
  const std::vector<double> sorted = sorted_sample(values);
  const std::vector<Level> levels = levels_of(sorted);
  std::vector<double> apart;
  for (std::size_t i = 1; i < levels.size(); ++i) {
    apart.push_back(levels[i].value - levels[i - 1].value);
  }
  if (apart.empty()) {
    return 0.0;
  }
  const double smallest = std::ranges::min(apart);
  constexpr double kFinestGrid_share = 1e-6;  // of the range: finer ones are how the digits were stored
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

double median_of(std::vector<double> values) { return values.empty() ? 0.0 : boost::math::statistics::median(values); }

NoiseLevel noise_level(std::span<const double> values, std::span<const std::pair<std::size_t, std::size_t>> runs) {
  std::vector<double> changes;
  std::vector<double> bends;
  std::size_t pairs = 0;
  const std::size_t stride = values.size() / kMostValues + 1;
  for (const auto& [begin, end] : runs) {
    for (std::size_t i = begin + 1; i < end; i += stride) {
      const double change = std::abs(values[i] - values[i - 1]);
      pairs += std::isnan(change) ? 0 : 1;
      if (change > 0.0) {
        changes.push_back(change);
      }
      if (i >= begin + 2) {
        const double bend = std::abs(values[i] - 2.0 * values[i - 1] + values[i - 2]);
        if (!std::isnan(bend)) {
          bends.push_back(bend);
        }
      }
    }
  }
  NoiseLevel level;
  level.step = resolution_of(values);
  level.repeats_share = pairs > 0 ? 1.0 - static_cast<double>(changes.size()) / static_cast<double>(pairs) : 0.0;
  level.usual = median_of(std::move(changes));
  level.noise = std::max(kMedianToSigma * median_of(std::move(bends)) / std::sqrt(6.0), level.step / std::sqrt(12.0));
  return level;
}

}  // namespace heatsoak
