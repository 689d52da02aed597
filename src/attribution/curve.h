// Curves without a known law: piecewise linear between seven equally spaced knots, constant outside, with a smoothness prior.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "attribution/regressors.h"
#include "attribution/rules.h"

namespace heatsoak::attribution {

inline constexpr int kKnots = 7;
/// Returns kKnots equally spaced knots from the low to the high end of the range.
std::vector<double> knots_from(const Regressor::Range& range);
/// Returns kKnots equally spaced knots over the range. For a signal with both signs that is no temperature, the range is extended so that
/// one knot is 0. The curve may then differ between forward and reverse, or driving and braking.
std::vector<double> knots_between(Regressor::Range range, RegressorKind kind);

/// The two hat functions that are nonzero at a value: knots `left` and `left` + 1, with weights 1 − right_share and right_share. Values
/// outside the knots are clamped.
struct HatsAt {
  Eigen::Index left = 0;
  double right_share = 0.0;
};
/// Returns the hat functions at a value.
HatsAt hats_at(const std::vector<double>& knots, double value);

/// Evaluates the piecewise linear curve with the given values at the knots.
double value_at(const std::vector<double>& knots, const Eigen::VectorXd& curve, double value);

/// Returns the prior precision of a curve at its knots, in units of its typical size: level · I + step · DᵀD, with D the first differences.
Eigen::MatrixXd curve_precision(Eigen::Index knots, const SelectionRules& rules);

}  // namespace heatsoak::attribution
