#include "attribution/curve.h"

#include <algorithm>
#include <cmath>

namespace heatsoak::attribution {
std::vector<double> knots_from(const Regressor::Range& range) {
  std::vector<double> knots(kKnots);
  for (int i = 0; i < kKnots; ++i) {
    knots[static_cast<std::size_t>(i)] = range.low + (range.high - range.low) * i / (kKnots - 1.0);
  }
  return knots;
}

std::vector<double> knots_between(Regressor::Range range, RegressorKind kind) {
  auto& [low, high] = range;
  if (low < 0.0 && high > 0.0 && kind != RegressorKind::node_temperature) {
    const double below = std::clamp(std::round(-low / (high - low) * (kKnots - 1.0)), 1.0, kKnots - 2.0);
    const double step = std::max(-low / below, high / (kKnots - 1.0 - below));
    low = -below * step;
    high = (kKnots - 1.0 - below) * step;
  }
  return knots_from(range);
}

HatsAt hats_at(const std::vector<double>& knots, double value) {
  const auto intervals = static_cast<double>(knots.size() - 1);
  const double place = std::clamp((value - knots.front()) / (knots.back() - knots.front()) * intervals, 0.0, intervals);
  const double left = std::min(std::floor(place), intervals - 1.0);
  return {static_cast<Eigen::Index>(left), place - left};
}

double value_at(const std::vector<double>& knots, const Eigen::VectorXd& curve, double value) {
  const HatsAt hats = hats_at(knots, value);
  return (1.0 - hats.right_share) * curve[hats.left] + hats.right_share * curve[hats.left + 1];
}

Eigen::MatrixXd curve_precision(Eigen::Index knots, const SelectionRules& rules) {
  Eigen::MatrixXd precision = Eigen::MatrixXd::Identity(knots, knots) * rules.curve_level_precision_ratio;
  for (Eigen::Index i = 0; i + 1 < knots; ++i) {
    precision(i, i) += rules.curve_step_precision_ratio;
    precision(i + 1, i + 1) += rules.curve_step_precision_ratio;
    precision(i, i + 1) -= rules.curve_step_precision_ratio;
    precision(i + 1, i) -= rules.curve_step_precision_ratio;
  }
  return precision;
}

}  // namespace heatsoak::attribution
