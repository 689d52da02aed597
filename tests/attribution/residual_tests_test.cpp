#include "attribution/residual_tests.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"

namespace heatsoak {
namespace {

/// White noise in runs of 30 samples, each of which begins with the last 15 samples of the run before. Put end to end, the runs correlate
/// at a lag of 15 samples; within a run they do not.
TEST(ResidualTests, CorrelationsDoNotCrossTheEndOfARun) {
  constexpr int kRuns = 40, kHalf = 15;
  Random random(7, 0);
  std::vector<Eigen::VectorXd> runs;
  Eigen::VectorXd joined(2 * kHalf * kRuns);
  for (int run = 0; run < kRuns; ++run) {
    Eigen::VectorXd values(2 * kHalf);
    for (double& value : values) {
      value = std::sqrt(12.0) * (random.uniform() - 0.5);
    }
    if (run > 0) {
      values.head(kHalf) = runs.back().tail(kHalf);
    }
    joined.segment(2 * kHalf * run, 2 * kHalf) = values;
    runs.push_back(values);
  }
  const InnovationTests apart = test_innovations("winding_C", runs, {});
  EXPECT_EQ(apart.count, 2 * kHalf * kRuns);
  EXPECT_GT(apart.ljung_box_probability, 1e-4);
  EXPECT_LT(test_innovations("winding_C", {joined}, {}).ljung_box_probability, 1e-10);
}

}  // namespace
}  // namespace heatsoak
