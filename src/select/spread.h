// Percentiles of samples, and their confidence intervals.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/confidence.h"
#include "select/evaluate.h"

namespace heatsoak::select {

/// Returns the quantile by linear interpolation between neighbouring samples. `sorted_C` must be sorted and not empty.
double quantile(std::span<const double> sorted_C, double share);

/// Returns the nominal value and the percentiles; without samples the percentiles are empty.
Spread95 spread(double nominal_C, std::vector<double> samples_C);

/// Assignment of samples to draws. Samples come in blocks of block_size; block b uses draw b mod draw_count.
struct SharedDraws {
  std::size_t draw_count = 1;
  std::size_t block_size = 1;
  std::uint64_t seed = 1;
};
using base::kBoundConfidence_share;
using base::kError_share;
/// Confidence intervals of the 95th percentile (level 1 − kError_share) and of the probability (level 1 − `error_share`). The upper end of
/// the percentile is infinite if there are fewer than fewest_samples_for_bound().
struct DrawIntervals {
  Interval95 p95;
  Interval95 probability;
};
/// Returns the smallest number of samples with an upper end of the 95th percentile's interval; if `is_drawn`, of samples in drawn games.
/// Independent samples need so many that their largest one lies above the percentile with a probability of kBoundConfidence_share.
int fewest_samples_for_bound(bool is_drawn);
/// Returns the intervals for independent samples, at least one. Probability: Clopper and Pearson (1934). Percentile: two order statistics,
/// whose ranks the binomial distribution gives.
DrawIntervals sample_intervals(std::span<const double> samples_C, std::span<const char> is_over, double error_share = kError_share);
/// Returns the intervals for samples that share draws. Percentile: bootstrap over the draws, each with all of its samples (Efron and
/// Tibshirani 1993, section 8.5). Probability: Clopper and Pearson with one trial per draw, which is conservative.
DrawIntervals draw_intervals(std::span<const double> samples_C, std::span<const char> is_over, const SharedDraws& shared,
                             double error_share = kError_share);

}  // namespace heatsoak::select
