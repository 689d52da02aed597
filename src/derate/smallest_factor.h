// Search for the smallest safety factor on heat that a check accepts.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <type_traits>

namespace heatsoak::derate {

/// A factor that was rejected and a larger one that was accepted.
struct FactorBracket {
  double low_ratio = 1.0;
  double high_ratio = 1.0;
};

/// Halves the bracket until it is at most 1 % wide. `is_enough(middle)` decides which half is kept.
template <class IsEnough>
FactorBracket bisected(FactorBracket bracket, const IsEnough& is_enough) {
  constexpr double kTolerance_ratio = 0.01;
  while (bracket.high_ratio > bracket.low_ratio * (1.0 + kTolerance_ratio)) {
    const double middle_ratio = 0.5 * (bracket.low_ratio + bracket.high_ratio);
    (is_enough(middle_ratio) ? bracket.high_ratio : bracket.low_ratio) = middle_ratio;
  }
  return bracket;
}

/// Returns the result of bisected() for a check that accepts every factor above one that it accepts. It tries the two factors at which the
/// bisection would end if `predict(bracket)` were the smallest factor accepted, and predicts again after each trial. A good prediction
/// saves trials; the result does not depend on it.
template <class IsEnough, class Predict>
double predicted_bisection(const FactorBracket& bracket, const IsEnough& is_enough, const Predict& predict) {
  constexpr int kMostPredictions = 6;
  FactorBracket known = bracket;
  for (int i = 0; i < kMostPredictions; ++i) {
    const double predicted_ratio = predict(known);
    const FactorBracket end =
        bisected(bracket, [&](double ratio) { return ratio >= known.high_ratio || (ratio > known.low_ratio && ratio >= predicted_ratio); });
    if (end.low_ratio <= known.low_ratio && end.high_ratio >= known.high_ratio) {
      return known.high_ratio;
    }
    // What motors keep at the lower factor they also keep at the higher one, so the lower one comes first.
    const double tried_ratio = end.low_ratio > known.low_ratio ? end.low_ratio : end.high_ratio;
    (is_enough(tried_ratio) ? known.high_ratio : known.low_ratio) = tried_ratio;
  }
  return bisected(bracket, [&](double ratio) { return ratio >= known.high_ratio || (ratio > known.low_ratio && is_enough(ratio)); })
      .high_ratio;
}

/// Returns the smallest factor in [from_ratio, most_ratio] that `is_enough(factor)` accepts, to 1 %; nothing if it rejects `most_ratio` as
/// well. The result itself was accepted. `growth_ratio`, > 1, is the first step upwards. Assumes that with a factor every larger one is
/// accepted, too. `predict` is that of predicted_bisection(); without one every middle is tried.
template <class IsEnough, class Predict = std::nullptr_t>
std::optional<double> smallest_factor(double from_ratio, double most_ratio, double growth_ratio, const IsEnough& is_enough,
                                      const Predict& predict = {}) {
  FactorBracket bracket{from_ratio, std::min(from_ratio, most_ratio)};
  if (is_enough(bracket.high_ratio)) {
    return bracket.high_ratio;
  }
  do {
    if (bracket.high_ratio >= most_ratio) {
      return std::nullopt;
    }
    bracket.low_ratio = bracket.high_ratio;
    bracket.high_ratio = std::min(bracket.high_ratio * growth_ratio, most_ratio);
  } while (!is_enough(bracket.high_ratio));
  if constexpr (std::is_null_pointer_v<Predict>) {
    return bisected(bracket, is_enough).high_ratio;
  } else {
    return predicted_bisection(bracket, is_enough, predict);
  }
}

}  // namespace heatsoak::derate
