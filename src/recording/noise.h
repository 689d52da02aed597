// Estimates noise and resolution of a channel without a model.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "recording/thinned.h"

namespace heatsoak::recording {

/// Median; 0 if `values` is empty. The values must not be NaN.
double median_of(std::vector<double> values);

/// Returns the resolution of the values: the spacing of their grid, or the median spacing if they are not on a grid but recur often, else
/// 0. If most values recur, values that occur once are ignored as bad samples. NaN are skipped.
double resolution_of(std::span<const double> values);

struct NoiseLevel {
  double step = 0.0;   ///< resolution_of()
  double usual = 0.0;  ///< median of the nonzero changes from one sample to the next
  /// Standard deviation of white noise: 1.4826 · median|second difference| / √6, but not below step/√12. Of more than 20 equal samples in
  /// a row, only the first 20 count.
  double noise = 0.0;
  double repeats_share = 0.0;  ///< share of neighbouring samples that are equal
  std::size_t distinct = 0;    ///< number of distinct values in the sample
};

/// Estimates the noise of a stream of values in order of time, NaN if missing. Memory is bounded: from long streams it keeps an evenly
/// spaced sample.
class NoiseGauge {
 public:
  explicit NoiseGauge(std::size_t most = Thinned::kMost) : values_(most), changes_(most), bends_(most) {}

  /// Begins a new run: differences do not extend over this point.
  void begin_run() {
    value_ = before_ = std::numeric_limits<double>::quiet_NaN();
    equal_ = 0;
  }
  void add(std::span<const double> values);
  [[nodiscard]] NoiseLevel level() const;

 private:
  Thinned values_;
  Thinned changes_;
  Thinned bends_;
  double value_ = std::numeric_limits<double>::quiet_NaN();  ///< last value
  double before_ = value_;                                   ///< value before the last
  std::size_t equal_ = 0;                                    ///< number of equal neighbours up to the last value
};

/// Noise of values in order of time. NaN are skipped; differences do not extend over the ends of `runs` ([begin, end)).
NoiseLevel noise_level(std::span<const double> values, std::span<const std::pair<std::size_t, std::size_t>> runs,
                       std::size_t most = Thinned::kMost);

}  // namespace heatsoak::recording
