// Steps of a least-squares descent within the bounds of the unknowns and within a trust region (Moré 1978).
#pragma once

#include <Eigen/Core>

namespace heatsoak::calibration {

/// Normal equations of a linearised least-squares problem: the cost falls by rightᵀ·step − ½·stepᵀ·normal·step.
struct NormalEquations {
  Eigen::MatrixXd normal;
  Eigen::VectorXd right;

  /// Returns the fall of the cost that the equations promise for a step.
  [[nodiscard]] double gain_of(const Eigen::VectorXd& step) const { return right.dot(step) - 0.5 * step.dot(normal * step); }
};

/// Limits of a step.
struct StepLimits {
  Eigen::VectorXd low, high;  ///< bounds of each component; low ≤ 0 ≤ high
  Eigen::VectorXd scale;      ///< one over the square of each unknown's usual change, at least 0; the unit of lengths

  /// Returns the length of a step in usual changes.
  [[nodiscard]] double length_of(const Eigen::VectorXd& step) const;
};

struct TrustedStep {
  Eigen::VectorXd step;
  double damping_ratio = 0.0;  ///< multiple of `scale` that was added to the diagonal of the normal matrix
};

/// Solves (normal + damping_ratio·scale)·step = right. A component that would leave its bounds stops there, and the others are solved
/// again.
Eigen::VectorXd bounded_step(const NormalEquations& equations, const StepLimits& limits, double damping_ratio);

/// Returns the best bounded step whose length is at most about `radius_ratio`.
TrustedStep trusted_step(const NormalEquations& equations, const StepLimits& limits, double radius_ratio);

}  // namespace heatsoak::calibration
