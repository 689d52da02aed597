#include "estimation/model_screening.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <vector>

#include "estimation/model_along_run.h"
#include "runs_for_tests.h"

namespace heatsoak::estimation {
namespace {

/// Long phases of large current heat the winding by several kelvins per second.
constexpr LogMaking kLog{
    .noise_K = 0.05, .resolution_K = 0.0, .outlier_share = 0.0, .dropout_share = 0.0, .largest_current_A = 15.0, .rows_per_load = 10};
constexpr int kWinding = 0;
/// Unknown heat that the screening assumes, in W.
constexpr double kUnknown_W = 0.05;

/// Sensors of which samples may be rejected.
enum class SensorsAre { winding, any };

struct Steep {
  TwoNodeTruth truth;
  Model model = two_node_model(truth, 1.0);
  MeasuredRun run = generated_run(truth, kLog, 1, 1);

  /// Returns the samples of the winding that the second pass rejects, given the true parameters.
  [[nodiscard]] std::set<Eigen::Index> rejected(SensorsAre sensors = SensorsAre::winding) const {
    const LinearisedRun fitted = linearise(model, measured_start_C(model.network, run), run);
    const Eigen::VectorXd weight = weights_by_model({fitted}, {run}, kUnknown_W).front();
    std::set<Eigen::Index> samples;
    for (Eigen::Index row = 0; row < weight.size(); ++row) {
      const bool is_winding = row % fitted.sensors() == kWinding;
      if (weight[row] == 0.0) {
        EXPECT_TRUE(is_winding || sensors == SensorsAre::any) << "sample " << row / fitted.sensors();
      }
      if (weight[row] == 0.0 && is_winding) {
        samples.insert(row / fitted.sensors());
      }
    }
    return samples;
  }

  /// Change of the winding's temperature after the sample, in K.
  [[nodiscard]] double rise_K(Eigen::Index k) const { return run.measured_C(k + 1, kWinding) - run.measured_C(k, kWinding); }

  /// Returns samples in the middle of a steep change that lasts for three samples or more.
  [[nodiscard]] std::vector<Eigen::Index> steep_samples() const {
    constexpr double kSteep_K = 1.0;
    constexpr Eigen::Index kApart = 30;
    std::vector<Eigen::Index> found;
    for (Eigen::Index k = kApart; k + 3 < run.samples(); ++k) {
      const bool is_steep = std::abs(rise_K(k)) > kSteep_K && rise_K(k - 1) * rise_K(k) > 0.0 && rise_K(k + 1) * rise_K(k) > 0.0;
      if (is_steep && (found.empty() || k > found.back() + kApart)) {
        found.push_back(k);
      }
    }
    return found;
  }
};

TEST(ModelScreening, KeepsGoodSamples) { EXPECT_TRUE(Steep().rejected().empty()); }

/// The next reading is near an outlier in the direction of the slope, but does not confirm it.
TEST(ModelScreening, RejectsOutliersOnSlopesAndNotTheirNeighbours) {
  Steep steep;
  const std::vector<Eigen::Index> samples = steep.steep_samples();
  ASSERT_GT(samples.size(), 5U);
  std::vector<double> off_K;
  for (const Eigen::Index k : samples) {
    off_K.push_back(1.7 * steep.rise_K(k));
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    steep.run.measured_C(samples[i], kWinding) += off_K[i];
  }
  EXPECT_EQ(steep.rejected(), std::set<Eigen::Index>(samples.begin(), samples.end()));
}

/// A sensor that slips off reads another temperature from then on. Changes on steep slopes may then look like outliers.
TEST(ModelScreening, KeepsAJumpThatStays) {
  constexpr double kMost_share = 0.01;
  Steep steep;
  const Eigen::Index half = steep.run.samples() / 2;
  steep.run.measured_C.col(kWinding).tail(half).array() += 15.0;
  EXPECT_LT(static_cast<double>(steep.rejected(SensorsAre::any).size()), kMost_share * static_cast<double>(half));
}

TEST(ModelScreening, RejectsTheLastSample) {
  Steep steep;
  const Eigen::Index last = steep.run.samples() - 1;
  steep.run.measured_C(last, kWinding) += 8.0;
  EXPECT_EQ(steep.rejected(), std::set<Eigen::Index>{last});
}

TEST(ModelScreening, RejectsAllOutliersOfADenseBurst) {
  Steep steep;
  std::set<Eigen::Index> wrong;
  for (Eigen::Index k = 600; k < 760; k += 2) {
    steep.run.measured_C(k, kWinding) += k % 4 == 0 ? 12.0 : -12.0;
    wrong.insert(k);
  }
  EXPECT_TRUE(std::ranges::includes(steep.rejected(SensorsAre::any), wrong));
}

TEST(ModelScreening, RejectsOutliersThatFollowEachOther) {
  Steep steep;
  std::set<Eigen::Index> wrong;
  double off_K = 8.0;
  for (const Eigen::Index k : steep.steep_samples()) {
    for (const Eigen::Index next : {k, k + 2, k + 3}) {
      steep.run.measured_C(next, kWinding) += off_K;
      wrong.insert(next);
      off_K = -off_K;
    }
  }
  EXPECT_EQ(steep.rejected(), wrong);
}

}  // namespace
}  // namespace heatsoak::estimation
