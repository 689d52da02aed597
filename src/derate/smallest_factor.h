// Search for the smallest safety factor on heat that a check accepts.
#pragma once

#include <algorithm>
#include <optional>

namespace heatsoak::derate {

/// Returns the smallest factor in [from_ratio, most_ratio] that `is_enough(factor)` accepts, to 1 %; nothing if it rejects `most_ratio` as
/// well. The result itself was accepted. `growth_ratio`, > 1, is the first step upwards. Assumes that with a factor every larger one is
/// accepted, too.
template <class IsEnough>
std::optional<double> smallest_factor(double from_ratio, double most_ratio, double growth_ratio, const IsEnough& is_enough) {
  constexpr double kTolerance_ratio = 0.01;
  double high_ratio = std::min(from_ratio, most_ratio);
  if (is_enough(high_ratio)) {
    return high_ratio;
  }
  double low_ratio = high_ratio;
  do {
    if (high_ratio >= most_ratio) {
      return std::nullopt;
    }
    low_ratio = high_ratio;
    high_ratio = std::min(high_ratio * growth_ratio, most_ratio);
  } while (!is_enough(high_ratio));
  while (high_ratio > low_ratio * (1.0 + kTolerance_ratio)) {
    const double middle_ratio = 0.5 * (low_ratio + high_ratio);
    (is_enough(middle_ratio) ? high_ratio : low_ratio) = middle_ratio;
  }
  return high_ratio;
}

}  // namespace heatsoak::derate
