// How a channel wobbles by itself, told without any model of it.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "identify/measurement/thinned.h"

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
  std::size_t distinct = 0;    ///< different values among those looked at
};

/// Takes a channel's values in the order of time, NaN where there is none. Memory does not grow with their number: of long
/// ones a sample is kept, spread evenly.
class NoiseGauge {
 public:
  explicit NoiseGauge(std::size_t most = Thinned::kMost) : values_(most), changes_(most), bends_(most) {}

  /// What comes next does not follow what came before.
  void begin_run() { value_ = before_ = std::numeric_limits<double>::quiet_NaN(); }
  void add(std::span<const double> values);
  [[nodiscard]] NoiseLevel level() const;

 private:
  Thinned values_;
  Thinned changes_;
  Thinned bends_;
  double value_ = std::numeric_limits<double>::quiet_NaN();  ///< the last one
  double before_ = value_;                                   ///< the one before it
};

/// Of values in the order of time; NaN are skipped, differences do not reach over `runs` ([begin, end)).
NoiseLevel noise_level(std::span<const double> values, std::span<const std::pair<std::size_t, std::size_t>> runs,
                       std::size_t most = Thinned::kMost);

}  // namespace heatsoak
