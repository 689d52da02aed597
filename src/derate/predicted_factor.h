// Predicts the safety factor at which a given share of motors exceeds a limit, from the shares at other factors.
#pragma once

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <vector>

#include "derate/smallest_factor.h"

namespace heatsoak::derate {

/// The factor that a motor needs is the product of its tolerances, so its logarithm is about normal. Between two factors, the logarithm is
/// interpolated linearly over the normal quantile of the share.
class PredictedFactor {
 public:
  /// `most_over` of `motors` may exceed a limit.
  PredictedFactor(int motors, int most_over) : motors_(motors), goal_quantile_ratio_(quantile_of(most_over + 0.5)) {}

  void take(double ratio, int over) { trials_.push_back({ratio, quantile_of(over)}); }

  /// Returns the predicted factor inside of the bracket, whose ends were taken.
  [[nodiscard]] double operator()(const FactorBracket& bracket) const {
    const double low = at(bracket.low_ratio);
    const double high = at(bracket.high_ratio);
    const double share = low > high ? std::clamp((low - goal_quantile_ratio_) / (low - high), 0.0, 1.0) : 0.5;
    return bracket.low_ratio * std::pow(bracket.high_ratio / bracket.low_ratio, share);
  }

 private:
  struct Trial {
    double ratio = 1.0;
    double quantile_ratio = 0.0;
  };
  /// Half a motor is added at both ends, where the quantile is infinite; the goal lies between two counts.
  [[nodiscard]] double quantile_of(double over_count) const {
    return boost::math::quantile(boost::math::normal_distribution<>(), (over_count + 0.5) / (motors_ + 1.0));
  }
  [[nodiscard]] double at(double ratio) const {
    const auto found = std::ranges::find(trials_, ratio, &Trial::ratio);
    return found == trials_.end() ? goal_quantile_ratio_ : found->quantile_ratio;
  }

  int motors_;
  double goal_quantile_ratio_;
  std::vector<Trial> trials_;
};

}  // namespace heatsoak::derate
