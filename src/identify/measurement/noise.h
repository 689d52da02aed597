// How a channel wobbles by itself, told without any model of it.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace heatsoak {

/// 0 where there is none; NaN are not allowed.
double median_of(std::vector<double> values);

struct NoiseLevel {
  double step = 0.0;   ///< smallest difference that the values have in common (resolution); 0 where none is seen
  double usual = 0.0;  ///< median change from one sample to the next, of those that change at all
  /// Standard deviation of white noise: 1.4826 · median|second difference| / √6, but not below step/√12.
  double noise = 0.0;
  double repeats_share = 0.0;  ///< of neighbours that are equal
};

/// Of values in the order of time; NaN are skipped, second differences span evenly spaced rows only within `runs` ([begin, end)).
NoiseLevel noise_level(std::span<const double> values, std::span<const std::pair<std::size_t, std::size_t>> runs);

}  // namespace heatsoak
