// Figures of channels that are robust enough to suspect something by.
#pragma once

#include <cstddef>
#include <span>

#include "identify/measurement/recording.h"

namespace heatsoak {

/// A percentile of what is there, 0 … 1; NaN where nothing is.
double percentile(std::span<const double> values, double share);
double middle_of(std::span<const double> values);
/// Of 98 % of the sizes: single wild samples do not count.
double top_of_sizes(std::span<const double> values);
/// No motor of a robot takes more: in milliamperes it would be little.
constexpr double kLargestCurrent_A = 300.0;
constexpr double kFastest_rad_per_s = 4000.0;  ///< 38 000 rpm
/// Without the wildest 2 % at both ends.
double swing(const Channel& channel);

/// Of the first five samples.
double at_start(const Channel& channel);
/// Of the last five.
double at_end(const Channel& channel);
/// Before the first heat warms it.
double coolest_at_start(const Channel& channel);

/// y = slope · x + intercept, in the units of what is given.
struct Regression {
  double slope = 0.0;
  double intercept = 0.0;
  double correlation_ratio = 0.0;  ///< 0 where one of the two does not vary
  std::size_t points = 0;
};
Regression regress(std::span<const double> x, std::span<const double> y);

}  // namespace heatsoak
