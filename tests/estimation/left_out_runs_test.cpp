#include "estimation/left_out_runs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "estimation/model_along_run.h"
#include "runs_for_tests.h"

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

constexpr double kLeast_nats = 10.0;

TEST(LeftOutNats, OneRecordingAloneConfirmsNothing) {
  EXPECT_FALSE(is_confirmed(gains_nats({reading(1000.0, 1.0)}), kLeast_nats));
  EXPECT_FALSE(is_confirmed(gains_nats({reading(1000.0, 1.0), reading(1000.0, 0.0), reading(1000.0, 0.0)}), kLeast_nats));
  EXPECT_TRUE(is_confirmed(gains_nats({reading(1000.0, 1.0), reading(1000.0, 1.0), reading(1000.0, 0.9)}), kLeast_nats));
}

TEST(LeftOutNats, ARecordingWithoutInformationNeitherConfirmsNorObjects) {
  const std::vector<Products> both{reading(1000.0, 1.0), reading(1000.0, 1.0)};
  const std::vector<Products> more{reading(1000.0, 1.0), reading(1000.0, 1.0), reading(0.01, 0.0)};
  EXPECT_TRUE(is_confirmed(gains_nats(both), kLeast_nats));
  EXPECT_TRUE(is_confirmed(gains_nats(more), kLeast_nats));
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

/// Runs of one motor, a model with the true parameters, and a fit to the runs.
struct FittedRuns {
  TwoNodeTruth truth;
  std::vector<MeasuredRun> runs;
  Posterior fit;
  PosteriorOptions options;

  explicit FittedRuns(std::size_t count) {
    for (std::size_t r = 0; r < count; ++r) {
      runs.push_back(generated_run(truth, {.flux_rms_W = 0.0, .outlier_share = 0.0}, 1, r + 1));
      runs.back().conditions["run"] = runs.back().name = "run" + std::to_string(r + 1);
    }
    const Model model = two_node_model(truth, 1.0);
    options = least_squares_options(model, 8);
    std::vector<std::vector<double>> start_C;
    for (const MeasuredRun& run : runs) {
      start_C.push_back(measured_start_C(model.network, run));
    }
    fit = posterior_of(model, runs, start_C, options);
  }
};

TEST(LeftOutErrors, OfAModelThatHoldsAreTheNoise) {
  const FittedRuns fitted(3);
  const double error_K = left_out_error_K(fitted.fit, fitted.runs, fitted.options);
  EXPECT_NEAR(error_K, fitted.runs.front().sensors.front().noise_K, 0.3 * fitted.runs.front().sensors.front().noise_K);
}

TEST(LeftOutErrors, ARunThatContradictsTheOthersRaisesThem) {
  FittedRuns fitted(3);
  const double before_K = left_out_error_K(fitted.fit, fitted.runs, fitted.options);
  fitted.runs[1].measured_C.array() +=
      5.0 * fitted.runs[1].measured_C.array().square() / fitted.runs[1].measured_C.array().square().maxCoeff();
  EXPECT_GT(left_out_error_K(fitted.fit, fitted.runs, fitted.options), 3.0 * before_K);
}

TEST(LeftOutErrors, StopAboveTheLargest) {
  const FittedRuns fitted(3);
  const double error_K = left_out_error_K(fitted.fit, fitted.runs, fitted.options);
  EXPECT_EQ(left_out_error_K(fitted.fit, fitted.runs, fitted.options, 1.001 * error_K), error_K);
  EXPECT_GT(left_out_error_K(fitted.fit, fitted.runs, fitted.options, 0.2 * error_K), 0.2 * error_K);
}

/// The known simulation saves time only; the readings are those of the runs given.
TEST(Posterior, FromAFitToOtherReadingsIsThatOfTheSameStart) {
  FittedRuns fitted(3);
  for (MeasuredRun& run : fitted.runs) {
    run.measured_C.array() += 1.0;
  }
  const Posterior from = posterior_from(fitted.fit, fitted.runs, fitted.options);
  const Posterior again = posterior_of(fitted.fit.model, fitted.runs, fitted.fit.start_C, fitted.options);
  EXPECT_EQ(from.model.theta(), again.model.theta());
  EXPECT_EQ(from.evidence_nats, again.evidence_nats);
  EXPECT_NE(from.model.theta(), fitted.fit.model.theta());
}

TEST(LeftOutErrors, NeedThreeRecordingsWithoutAnEffectOfTheirOwn) {
  const FittedRuns two(2);
  EXPECT_FALSE(can_leave_out(two.fit.model, two.runs));
  FittedRuns fitted(3);
  EXPECT_TRUE(can_leave_out(fitted.fit.model, fitted.runs));
  RunDeviation deviation;
  deviation.condition = {{"run", "run2"}};
  fitted.fit.model.deviations.push_back(deviation);
  EXPECT_EQ(own_effect_count(fitted.fit.model, fitted.runs, fitted.runs[1]), 1);
  EXPECT_EQ(own_effect_count(fitted.fit.model, fitted.runs, fitted.runs[0]), 0);
  EXPECT_FALSE(can_leave_out(fitted.fit.model, fitted.runs));
  // The third run alone lacks the condition, so without it nothing separates the effect from the motor's own parameters.
  for (const std::size_t r : {0, 1}) {
    fitted.runs[r].conditions["fan"] = "on";
  }
  fitted.runs[2].conditions["fan"] = "off";
  fitted.fit.model.deviations.front().condition = {{"fan", "on"}};
  EXPECT_EQ(own_effect_count(fitted.fit.model, fitted.runs, fitted.runs[2]), 1);
}

TEST(LeftOutErrors, RejectedSamplesDoNotCount) {
  FittedRuns fitted(2);
  MeasuredRun wrong = fitted.runs[0];
  wrong.measured_C(3, 1) += 40.0;
  Eigen::VectorXd weight = Eigen::VectorXd::Ones(wrong.measured_C.size());
  weight[3 * wrong.measured_C.cols() + 1] = 0.0;
  const MeasuredRun kept = without_rejected(wrong, weight);
  EXPECT_TRUE(std::isnan(kept.measured_C(3, 1)));
  EXPECT_EQ(kept.measured_C(3, 0), wrong.measured_C(3, 0));
  EXPECT_EQ(without_rejected(wrong, {}).measured_C(3, 1), wrong.measured_C(3, 1));
}

}  // namespace
}  // namespace heatsoak::estimation
