// Robust location and regression, compared with exact answers and with samples of known truth.
#include "friction/robust_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <numeric>
#include <random>

#include "support/seed_rate.h"

namespace heatsoak::friction {
namespace {

TEST(RobustLocation, a_fifth_of_nonsense_moves_it_by_less_than_a_tenth_of_the_noise) {
  // The standard error of the location is 0.2/√3200 = 0.0035, and a normal value is beyond the cut-off once in 3e5.
  EXPECT_TRUE(holds_for_share(0.99, 100, [](std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    std::normal_distribution<double> noise(5.0, 0.2);
    std::vector<double> values;
    for (int i = 0; i < 4000; ++i) {
      values.push_back(i % 5 == 0 ? (i % 2 == 0 ? 40.0 : 0.0) : noise(engine));
    }
    const RobustLocation found = robust_location(values, 0.0);
    const auto kept = static_cast<double>(std::count(found.kept.begin(), found.kept.end(), true));
    return std::abs(found.value.value() - 5.0) < 0.02 && std::abs(kept - 3200.0) <= 5.0;
  }));
}

TEST(RobustLocation, of_steps_of_a_sensor_is_between_them) {
  const std::vector<double> values{1.0, 1.0, 1.0, 1.0, 1.1, 1.1, 7.0};
  const RobustLocation found = robust_location(values, 0.1);
  EXPECT_GT(found.value, 1.0);
  EXPECT_LT(found.value, 1.1);
  EXPECT_FALSE(found.kept[6]);
}

TEST(RobustLocation, of_no_finite_value_is_empty) {
  const std::vector<double> values{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()};
  const RobustLocation found = robust_location(values, 0.1);
  EXPECT_EQ(found.value, std::nullopt);
  EXPECT_THAT(found.kept, testing::Each(false));
}

TEST(RobustFit, is_exact_where_most_rows_are) {
  Eigen::MatrixXd X(20, 2);
  Eigen::VectorXd y(20);
  std::vector<int> cluster(20);
  std::iota(cluster.begin(), cluster.end(), 0);
  for (int i = 0; i < 20; ++i) {
    X.row(i) << 1.0, 0.1 * i;
    y(i) = 2.0 - 3.0 * 0.1 * i + (i % 5 == 2 ? 50.0 : 0.0);
  }
  const RobustFit fit = robust_fit(X, y, cluster);
  EXPECT_NEAR(fit.coefficients(0), 2.0, 1e-9);
  EXPECT_NEAR(fit.coefficients(1), -3.0, 1e-9);
  EXPECT_EQ(fit.weights(2), 0.0);
}

/// Scatter that grows along the line, and 15 % gross errors: the intervals must still hold the truth in 95 % of the samples.
TEST(RobustFit, intervals_of_unequal_scatter) {
  std::mt19937_64 engine(2);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> any(0.0, 1.0);
  int inside = 0;
  constexpr int kSamples = 1000;
  for (int sample = 0; sample < kSamples; ++sample) {
    Eigen::MatrixXd X(40, 2);
    Eigen::VectorXd y(40);
    std::vector<int> cluster(40);
    std::iota(cluster.begin(), cluster.end(), 0);
    for (int i = 0; i < 40; ++i) {
      const double x = -1.0 + i / 19.5;
      X.row(i) << 1.0, x;
      y(i) = 0.5 + 2.0 * x + (0.1 + 0.2 * std::abs(x)) * normal(engine) + (any(engine) < 0.15 ? 10.0 * (any(engine) - 0.5) : 0.0);
    }
    const Estimate slope = robust_fit(X, y, cluster).estimate(1);
    inside += slope.interval->low <= 2.0 && 2.0 <= slope.interval->high ? 1 : 0;
  }
  EXPECT_GE(inside, 0.93 * kSamples);
  EXPECT_LE(inside, 0.98 * kSamples);
}

/// Only three of twelve clusters of three rows determine the second coefficient. The intervals must keep their 95 % coverage.
TEST(RobustFit, intervals_keep_their_coverage_if_few_clusters_determine_a_coefficient) {
  std::mt19937_64 engine(3);
  std::normal_distribution<double> normal;
  int inside = 0;
  constexpr int kSamples = 1000;
  for (int sample = 0; sample < kSamples; ++sample) {
    Eigen::MatrixXd X(36, 2);
    Eigen::VectorXd y(36);
    std::vector<int> cluster(36);
    for (int i = 0; i < 36; ++i) {
      cluster[static_cast<std::size_t>(i)] = i / 3;
      X.row(i) << 1.0, i < 9 ? 1.0 : 0.0;
      y(i) = 0.5 + 2.0 * X(i, 1) + 0.1 * normal(engine);
    }
    const RobustFit fit = robust_fit(X, y, cluster);
    EXPECT_LT(fit.freedom_counts(1), 7.0);
    const Estimate step = fit.estimate(1);
    inside += step.interval->low <= 2.0 && 2.0 <= step.interval->high ? 1 : 0;
  }
  EXPECT_GE(inside, 0.93 * kSamples);
  EXPECT_LE(inside, 0.98 * kSamples);
}

TEST(RobustFit, reports_which_columns_are_collinear) {
  Eigen::MatrixXd X(10, 3);
  for (int i = 0; i < 10; ++i) {
    X.row(i) << 1.0, i, 2.0 * i + 3.0;
  }
  EXPECT_LT(independent_share(X, 2), 1e-9);
  EXPECT_NEAR(independent_share(X.leftCols(2), 1), std::sqrt(82.5 / 285.0), 1e-12);  // share for the values 0 … 9 after removing their mean
}

}  // namespace
}  // namespace heatsoak::friction
