// How a channel wobbles by itself, told without any model of it.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace heatsoak {

/// 0 where there is none; NaN are not allowed.
double median_of(std::vector<double> values);

/// The grid that the values lie on, or where they lie on none but come back again and again, how far apart they are; 0
/// where neither. Values that come once among many that come often are bad samples and do not count; NaN are skipped.
double resolution_of(std::span<const double> values);

struct NoiseLevel {
  double step = 0.0;   ///< resolution_of()
  double usual = 0.0;  ///< median change from one sample to the next, of those that change at all
  /// Standard deviation of white noise: 1.4826 · median|second difference| / √6, but not below step/√12.
  double noise = 0.0;
  double repeats_share = 0.0;  ///< of neighbours that are equal
};

/// Of values in the order of time; NaN are skipped, differences do not reach over `runs` ([begin, end)). Of a long log
/// some 200 000 samples are looked at, spread evenly.
NoiseLevel noise_level(std::span<const double> values, std::span<const std::pair<std::size_t, std::size_t>> runs);

}  // namespace heatsoak
