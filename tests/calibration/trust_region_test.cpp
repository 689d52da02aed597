// Bounded steps within a trust region, compared with the conditions of the optimum.
#include "calibration/forecast/trust_region.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>

namespace heatsoak::calibration {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// Two unknowns of which the data determine almost only the sum, and a third one.
NormalEquations valley() {
  NormalEquations out{Eigen::MatrixXd(3, 3), Eigen::Vector3d(1000.0, 998.0, 3.0)};
  out.normal << 1000.0, 999.0, 0.0, 999.0, 1000.0, 1.0, 0.0, 1.0, 4.0;
  return out;
}

StepLimits unlimited() { return {Eigen::Vector3d::Constant(-kFar), Eigen::Vector3d::Constant(kFar), Eigen::Vector3d::Ones()}; }

TEST(TrustRegion, AStepWithoutLimitsIsTheMinimum) {
  const NormalEquations equations = valley();
  const TrustedStep found = trusted_step(equations, unlimited(), 1e3);
  EXPECT_EQ(found.damping_ratio, 0.0);
  EXPECT_LT((equations.normal * found.step - equations.right).norm(), 1e-8);
}

/// At the optimum the slope vanishes for each unknown within its bounds and points outwards for those at a bound.
TEST(TrustRegion, ABoundOfOneUnknownMovesTheOthers) {
  const NormalEquations equations = valley();
  StepLimits limits = unlimited();
  limits.high[0] = 0.1;
  const Eigen::VectorXd step = bounded_step(equations, limits, 0.0);
  const Eigen::VectorXd slope = equations.right - equations.normal * step;
  EXPECT_EQ(step[0], 0.1);
  EXPECT_GT(slope[0], 0.0);
  EXPECT_NEAR(slope[1], 0.0, 1e-8);
  EXPECT_NEAR(slope[2], 0.0, 1e-8);
  Eigen::VectorXd clipped = equations.normal.ldlt().solve(equations.right);
  clipped[0] = 0.1;
  EXPECT_GT(equations.gain_of(step), equations.gain_of(clipped) + 100.0) << "clipping alone leaves the valley";
}

TEST(TrustRegion, AnUnknownAtItsBoundStaysThereIfItWouldLeave) {
  StepLimits limits = unlimited();
  limits.high.setZero();
  EXPECT_EQ(bounded_step(valley(), limits, 0.0), Eigen::VectorXd(Eigen::Vector3d::Zero()));
}

/// A short step goes down the steep slope and loses only what lies along the valley.
TEST(TrustRegion, AShortStepGainsMoreThanOneAlongTheSlope) {
  const NormalEquations equations = valley();
  StepLimits limits = unlimited();
  limits.scale = Eigen::Vector3d(1.0, 4.0, 1.0);
  for (const double radius : {0.05, 0.3, 1.0}) {
    const TrustedStep found = trusted_step(equations, limits, radius);
    EXPECT_LE(limits.length_of(found.step), radius);
    EXPECT_GT(limits.length_of(found.step), 0.8 * radius);
    Eigen::VectorXd steepest = equations.right.cwiseQuotient(limits.scale);
    steepest *= std::min(limits.length_of(found.step) / limits.length_of(steepest),
                         equations.right.dot(steepest) / steepest.dot(equations.normal * steepest));
    EXPECT_GT(equations.gain_of(found.step), equations.gain_of(steepest));
  }
}

}  // namespace
}  // namespace heatsoak::calibration
