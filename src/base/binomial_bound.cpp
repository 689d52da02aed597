#include "base/binomial_bound.h"

#include <boost/math/distributions/binomial.hpp>
#include <cmath>

namespace heatsoak::base {

double upper_bound_share(double over_count, double draws_count, double confidence) {
  if (over_count >= draws_count) {
    return 1.0;
  }
  return boost::math::binomial_distribution<>::find_upper_bound_on_p(draws_count, over_count, 1.0 - confidence);
}

ShareInterval share_interval(double over_share, double draws_count, double error_share) {
  const bool is_open = over_share <= 0.0 || over_share >= 1.0;
  const double confidence = 1.0 - (is_open ? error_share : 0.5 * error_share);
  return {1.0 - upper_bound_share((1.0 - over_share) * draws_count, draws_count, confidence),
          upper_bound_share(over_share * draws_count, draws_count, confidence)};
}

std::optional<long> draws_needed(double over_share, double limit_share, double confidence) {
  if (!(over_share < limit_share)) {
    return std::nullopt;
  }
  constexpr long kMost = 100'000'000;
  const auto suffices = [&](long draws) {
    const auto count = static_cast<double>(draws);
    return upper_bound_share(std::ceil(over_share * count - 1e-9), count, confidence) <= limit_share;
  };
  long high = 1;
  while (!suffices(high)) {
    high *= 2;
    if (high > kMost) {
      return std::nullopt;
    }
  }
  long low = high / 2;
  while (high - low > 1) {
    const long middle = low + (high - low) / 2;
    (suffices(middle) ? high : low) = middle;
  }
  return high;
}

long fewest_draws(double limit_share, double confidence) {
  constexpr double kRounding = 1e-9;
  return static_cast<long>(std::ceil(std::log(1.0 - confidence) / std::log1p(-limit_share) * (1.0 - kRounding)));
}

}  // namespace heatsoak::base
