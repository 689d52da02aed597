// Upper confidence bound of a probability that was estimated from a few draws.
#pragma once

#include <optional>

namespace heatsoak {

/// Upper confidence bound of a probability, one-sided and exact (Clopper and Pearson 1934): were the probability higher, so few of `draws`
/// would be over with a chance of less than 1 − `confidence`. `over_count` of them were; it need not be whole. 1 without draws.
double upper_bound_share(double over_count, double draws_count, double confidence);

/// Two-sided interval of a probability, exact (Clopper and Pearson 1934): it misses the probability with a chance of at most `error_share`.
/// Where none or all of the draws are over, the whole `error_share` goes to the side that is open.
struct ShareInterval {
  double low = 0.0;
  double high = 1.0;
};
ShareInterval share_interval(double over_share, double draws_count, double error_share);

/// The fewest draws with which a limit can be kept if the same share of them is over, "over_share" of each; nothing where no number
/// suffices because the share itself is at the limit or above it.
std::optional<long> draws_needed(double over_share, double limit_share, double confidence);

/// The fewest draws that show `limit_share` where none is over: the smallest n with (1 − limit_share)ⁿ ≤ 1 − confidence.
long fewest_draws(double limit_share, double confidence);

}  // namespace heatsoak
