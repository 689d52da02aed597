#include "identify/measurement/noise.h"

#include <algorithm>
#include <boost/math/statistics/univariate_statistics.hpp>
#include <cmath>

namespace heatsoak {
namespace {

constexpr std::size_t kMostValues = 200'000;  ///< of which a step is sought
constexpr double kMedianToSigma = 1.4826;

/// The grid that the values lie on, or where they lie on none but come back again and again, how far apart they are.
double step_of(std::span<const double> values) {
  std::vector<double> sorted;
  for (const double value : values.first(std::min(values.size(), kMostValues))) {
    if (!std::isnan(value)) {
      sorted.push_back(value);
    }
  }
  const std::size_t count = sorted.size();
  std::ranges::sort(sorted);
  std::vector<double> apart;
  std::size_t distinct = count > 0 ? 1 : 0;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    const double difference = sorted[i] - sorted[i - 1];
    if (difference > 1e-9 * std::max(std::abs(sorted[i]), std::abs(sorted[i - 1]))) {
      apart.push_back(difference);
      ++distinct;
    }
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
  if (apart.size() >= 3 && smallest > kFinestGrid_share * (sorted.back() - sorted.front()) &&
      static_cast<double>(on_grid) >= kOnGrid_share * static_cast<double>(apart.size())) {
    return smallest;
  }
  return distinct * 5 < count ? median_of(std::move(apart)) : 0.0;
}

}  // namespace

double median_of(std::vector<double> values) { return values.empty() ? 0.0 : boost::math::statistics::median(values); }

NoiseLevel noise_level(std::span<const double> values, std::span<const std::pair<std::size_t, std::size_t>> runs) {
  std::vector<double> changes;
  std::vector<double> bends;
  std::size_t pairs = 0;
  for (const auto& [begin, end] : runs) {
    for (std::size_t i = begin + 1; i < end; ++i) {
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
  level.step = step_of(values);
  level.repeats_share = pairs > 0 ? 1.0 - static_cast<double>(changes.size()) / static_cast<double>(pairs) : 0.0;
  level.usual = median_of(std::move(changes));
  level.noise = std::max(kMedianToSigma * median_of(std::move(bends)) / std::sqrt(6.0), level.step / std::sqrt(12.0));
  return level;
}

}  // namespace heatsoak
