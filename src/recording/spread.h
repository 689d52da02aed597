// Robust statistics of channels for plausibility checks.
#pragma once

#include <cstddef>
#include <span>

#include "recording/recording.h"

namespace heatsoak::recording {

/// Quantile of the values that are not NaN; `share` is 0 to 1. NaN if there are none.
double percentile(std::span<const double> values, double share);
/// Median of the values that are not NaN; NaN if there are none.
double middle_of(std::span<const double> values);
/// 98th percentile of the magnitudes, insensitive to single outliers.
double top_of_sizes(std::span<const double> values);
/// Largest current of any robot's motor. Larger numbers are probably in milliamperes.
constexpr double kLargestCurrent_A = 300.0;
constexpr double kFastest_rad_per_s = 4000.0;  ///< 38 000 rpm
/// Range from the 2nd to the 98th percentile.
double swing(const Channel& channel);

/// Median of the first five valid samples.
double at_start(const Channel& channel);
/// Median of the last five valid samples.
double at_end(const Channel& channel);
/// Smallest of the first five valid samples, before heat can raise it.
double coolest_at_start(const Channel& channel);

/// Linear regression y = slope · x + intercept, in the units of x and y.
struct Regression {
  double slope = 0.0;
  double intercept = 0.0;
  double correlation_ratio = 0.0;  ///< −1 to 1; 0 if x or y does not vary
  std::size_t points = 0;
};
/// Fits a line to pairs without NaN. The slope is 0 if x or y does not vary.
Regression regress(std::span<const double> x, std::span<const double> y);

}  // namespace heatsoak::recording
