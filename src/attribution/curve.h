// Curves that nobody declared: straight between seven evenly spaced knots, constant outside, smooth before anything is measured.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "attribution/regressors.h"
#include "attribution/rules.h"

namespace heatsoak {

inline constexpr int kKnots = 7;
std::vector<double> knots_from(const Regressor::Range& range);
/// Where a driver (no temperature) changes its sign one of them is 0: forwards and backwards, driving and braking differ.
std::vector<double> knots_between(Regressor::Range range, DriverKind kind);
std::vector<double> knots_over(const Regressor& driver);

/// The two hat functions that are not 0 at a value, which is clamped to the outer knots.
struct HatsAt {
  Eigen::Index left = 0;
  double right_share = 0.0;
};
HatsAt hats_at(const std::vector<double>& knots, double value);

/// A curve with its values at the knots.
double value_at(const std::vector<double>& knots, const Eigen::VectorXd& curve, double value);

/// Precision of a curve before anything is measured, in units of its usual size: level · I + step · DᵀD.
Eigen::MatrixXd curve_precision(Eigen::Index knots, const SelectionRules& rules);

}  // namespace heatsoak
