// Exact confidence bounds of a probability that is estimated from a finite number of draws.
#pragma once

#include <optional>

namespace heatsoak::base {

/// Returns the one-sided upper confidence bound of a probability, 0 to 1, exact (Clopper and Pearson 1934). `over_count` of `draws_count`
/// draws were over the limit; it need not be an integer. A higher probability would give so few draws over the limit
/// with a chance below 1 − `confidence`. Returns 1 if all draws are over or there are none.
double upper_bound_share(double over_count, double draws_count, double confidence);

/// Two-sided confidence interval of a probability, exact (Clopper and Pearson 1934). It misses the true probability with a chance of at
/// most `error_share`. If none or all of the draws are over the limit, one bound is trivial and the other bound gets the whole
/// `error_share`.
struct ShareInterval {
  double low = 0.0;
  double high = 1.0;
};
ShareInterval share_interval(double over_share, double draws_count, double error_share);

/// Returns the smallest number of draws whose upper bound is at most `limit_share`, if the share `over_share` of them is over the limit.
/// Returns nothing if `over_share` is not below `limit_share` or more than 100 million draws would be needed.
std::optional<long> draws_needed(double over_share, double limit_share, double confidence);

/// Returns the number of draws, none of them over, that shows a probability of at most `limit_share`:
/// the smallest n with (1 − limit_share)ⁿ ≤ 1 − confidence.
long fewest_draws(double limit_share, double confidence);

}  // namespace heatsoak::base
