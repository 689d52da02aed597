// Percentiles of samples, and how far they can be trusted.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "select/evaluate.h"

namespace heatsoak {

/// Between the two samples next to the place, linearly; `sorted_C` is not empty.
double quantile(std::span<const double> sorted_C, double share);

/// NaN but for the nominal figure where there are no samples.
Spread95 spread(double nominal_C, std::vector<double> samples_C);

/// Samples came in blocks, and block b shares draw b mod draw_count with all others of that draw.
struct SharedDraws {
  std::size_t draw_count = 1;
  std::size_t block_size = 1;
  std::uint64_t seed = 1;
};
/// 95 % confidence intervals, as far as the number of draws or samples goes. The percentile's high end is infinite where they are too few
/// to tell: fewer than 72 samples that share nothing, or than 20 draws.
struct DrawIntervals {
  Interval95 p95;
  Interval95 probability;
};
/// Of samples that share nothing: the probability after Wilson (1927), the percentile between two of the sorted samples whose places
/// the binomial distribution gives. There is at least one sample.
DrawIntervals sample_intervals(std::span<const double> samples_C, std::span<const char> is_over);
/// Bootstrap over the draws, each with all samples that share it (Efron and Tibshirani 1993, section 8.5).
DrawIntervals draw_intervals(std::span<const double> samples_C, std::span<const char> is_over, const SharedDraws& shared);

}  // namespace heatsoak
