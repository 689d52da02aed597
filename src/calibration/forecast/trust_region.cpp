#include "calibration/forecast/trust_region.h"

#include <Eigen/Dense>
#include <cmath>
#include <vector>

namespace heatsoak::calibration {

double StepLimits::length_of(const Eigen::VectorXd& step) const { return std::sqrt(step.dot(scale.cwiseProduct(step))); }

Eigen::VectorXd bounded_step(const NormalEquations& equations, const StepLimits& limits, double damping_ratio) {
  const Eigen::Index count = equations.right.size();
  Eigen::MatrixXd normal = equations.normal;
  normal.diagonal() += damping_ratio * limits.scale;
  Eigen::VectorXd step = Eigen::VectorXd::Zero(count);
  std::vector<Eigen::Index> moving;
  for (Eigen::Index i = 0; i < count; ++i) {
    const double room = equations.right[i] > 0.0 ? limits.high[i] : -limits.low[i];
    if (room > 0.0) {
      moving.push_back(i);
    }
  }
  while (!moving.empty()) {
    Eigen::VectorXd stopped = step;
    stopped(moving).setZero();
    const Eigen::VectorXd right = (equations.right - normal * stopped)(moving);
    step(moving) = Eigen::VectorXd(Eigen::MatrixXd(normal(moving, moving)).ldlt().solve(right));
    const std::size_t left = std::erase_if(moving, [&](Eigen::Index i) { return step[i] < limits.low[i] || step[i] > limits.high[i]; });
    step = step.cwiseMax(limits.low).cwiseMin(limits.high);
    if (left == 0) {
      break;
    }
  }
  return step;
}

TrustedStep trusted_step(const NormalEquations& equations, const StepLimits& limits, double radius_ratio) {
  TrustedStep found{bounded_step(equations, limits, 0.0)};
  if (limits.length_of(found.step) <= radius_ratio) {
    return found;
  }
  // The length falls with the damping_ratio. The curvature of the stiffest direction in units of the scale is more than enough.
  double low = -20.0;
  double high = 40.0;
  constexpr double kPrecise = 0.1;
  while (high - low > kPrecise) {
    const double middle = 0.5 * (low + high);
    (limits.length_of(bounded_step(equations, limits, std::exp(middle))) > radius_ratio ? low : high) = middle;
  }
  found.damping_ratio = std::exp(high);
  found.step = bounded_step(equations, limits, found.damping_ratio);
  return found;
}

}  // namespace heatsoak::calibration
