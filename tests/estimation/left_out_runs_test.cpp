#include "estimation/left_out_runs.h"

#include <gtest/gtest.h>

#include <cmath>

namespace heatsoak::estimation {
namespace {

/// One effect whose column is 1 in every reading: readings of unit variance with mean 1, `count` per recording.
Products reading(double count, double mean) {
  Products out;
  out.square.resize(2, 2);
  out.square << count, count * mean, count * mean, count * mean * mean;
  return out;
}

ThetaPrior no_theta() { return {Eigen::MatrixXd(0, 0), Eigen::VectorXd(0)}; }

/// ln evidence of a normal mean with a standard normal prior.
double with_effect_nats(const Reduced& at) {
  const double precision = 1.0 + at.products(0, 0);
  return at.base_nats + 0.5 * at.right[0] * at.right[0] / precision - 0.5 * std::log(precision);
}
double without_effect_nats(const Reduced& at) { return at.base_nats; }

Eigen::VectorXd gains_nats(const std::vector<Products>& parts) {
  return left_out_nats(parts, no_theta(), with_effect_nats) - left_out_nats(parts, no_theta(), without_effect_nats);
}

TEST(LeftOutNats, AreThoseOfTheNormalDistribution) {
  const std::vector<Products> parts{reading(1.0, 2.0), reading(3.0, 1.0)};
  // The second recording gives the mean a posterior N(3/4, 1/4), so the first reading of 2 has N(3/4, 5/4).
  const double predicted_nats = -0.5 * std::pow(2.0 - 0.75, 2) / 1.25 - 0.5 * std::log(1.25);
  EXPECT_NEAR(gains_nats(parts)[0], predicted_nats + 0.5 * 4.0, 1e-6);
}

TEST(LeftOutNats, OneRecordingAloneConfirmsNothing) {
  EXPECT_FALSE(is_confirmed(gains_nats({reading(1000.0, 1.0)})));
  EXPECT_FALSE(is_confirmed(gains_nats({reading(1000.0, 1.0), reading(1000.0, 0.0), reading(1000.0, 0.0)})));
  EXPECT_TRUE(is_confirmed(gains_nats({reading(1000.0, 1.0), reading(1000.0, 1.0), reading(1000.0, 0.9)})));
}

TEST(LeftOutNats, ARecordingWithoutInformationNeitherConfirmsNorObjects) {
  const std::vector<Products> both{reading(1000.0, 1.0), reading(1000.0, 1.0)};
  const std::vector<Products> more{reading(1000.0, 1.0), reading(1000.0, 1.0), reading(0.01, 0.0)};
  EXPECT_TRUE(is_confirmed(gains_nats(both)));
  EXPECT_TRUE(is_confirmed(gains_nats(more)));
}

TEST(LeftOutNats, PartsOfOneRecordingAreLeftOutTogether) {
  std::vector<MeasuredRun> runs(3);
  runs[0].name = "a";
  runs[0].conditions["run"] = "a";
  runs[1].name = "a#2";
  runs[1].conditions["run"] = "a";
  runs[2].name = "b";
  const std::vector<Products> sums = by_recording({reading(1.0, 2.0), reading(2.0, 3.0), reading(4.0, 1.0)}, runs);
  ASSERT_EQ(sums.size(), 2U);
  EXPECT_EQ(sums[0].square(0, 0), 3.0);
  EXPECT_EQ(sums[1].square(0, 0), 4.0);
}

}  // namespace
}  // namespace heatsoak::estimation
