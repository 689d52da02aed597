// Percentiles of samples, and how far they can be trusted.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "select/evaluate.h"

namespace heatsoak::select {

/// Between the two samples next to the place, linearly; `sorted_C` is not empty.
double quantile(std::span<const double> sorted_C, double share);

/// NaN but for the nominal parameter where there are no samples.
Spread95 spread(double nominal_C, std::vector<double> samples_C);

/// Samples came in blocks, and block b shares draw b mod draw_count with all others of that draw.
struct SharedDraws {
  std::size_t draw_count = 1;
  std::size_t block_size = 1;
  std::uint64_t seed = 1;
};
/// Confidence intervals: of the 95th percentile with 95 %, of the probability with 1 − `error_share`. The percentile's high end is infinite
/// where there are too few to tell: fewer than 72 samples that share nothing, or than 20 draws.
struct DrawIntervals {
  Interval95 p95;
  Interval95 probability;
};
inline constexpr double kError_share = 0.05;
/// Of samples that share nothing: the probability after Clopper and Pearson (1934), the percentile between two of the sorted samples whose
/// places the binomial distribution gives. There is at least one sample.
DrawIntervals sample_intervals(std::span<const double> samples_C, std::span<const char> is_over, double error_share = kError_share);
/// The percentile by a bootstrap over the draws, each with all samples that share it (Efron and Tibshirani 1993, section 8.5). The
/// probability after Clopper and Pearson with as many trials as draws: samples of one draw count as one, which errs on the safe side.
DrawIntervals draw_intervals(std::span<const double> samples_C, std::span<const char> is_over, const SharedDraws& shared,
                             double error_share = kError_share);

}  // namespace heatsoak::select
