#include "duty/demand.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "base/random.h"

namespace heatsoak::duty {
namespace {

const DemandGatherer::Grid kGrid{};

// Reference: 0.1 N m at 100 rad/s for 1 s, then −0.05 N m at 40 rad/s for 3 s: (10·1 − 2·3)/4 = 1 W.
TEST(DemandGatherer, power_is_the_mean_of_the_products) {
  DemandGatherer gatherer("wheel", 4.0, kGrid);
  gatherer.add(1.0, 0.1, 100.0);
  gatherer.add(3.0, -0.05, 40.0);
  const WheelDemand demand = gatherer.finish();
  ASSERT_EQ(demand.bins.size(), 1U);
  EXPECT_NEAR(demand.bins[0].power_mean_W, 1.0, 1e-14);
  EXPECT_NEAR(constant_bin(2.0, -0.05, 40.0, 0.0).power_mean_W, -2.0, 1e-15);
}

// Triangular speed between −30 and 30 rad/s with slopes of ±60 rad/s², a thousand steps per second.
TEST(DemandGatherer, acceleration_is_the_mean_of_its_magnitude_through_reversals_and_across_bins) {
  DemandGatherer gatherer("wheel", 0.7, kGrid);
  for (int i = 0; i < 7000; ++i) {
    const int phase = i % 2000;
    gatherer.add(1e-3, 0.0, phase < 1000 ? -30.0 + 0.06 * phase : 30.0 - 0.06 * (phase - 1000));
  }
  const WheelDemand demand = gatherer.finish();
  ASSERT_EQ(demand.bins.size(), 10U);
  for (std::size_t i = 0; i < demand.bins.size(); ++i) {
    // The first moment has no predecessor.
    EXPECT_NEAR(demand.bins[i].acceleration_rad_per_s2, i == 0 ? 60.0 * 699.0 / 700.0 : 60.0, 1e-9) << i;
  }
}

// Reference: −2 A, which brakes, for 1 s and 6 A for 3 s: (4·1 + 36·3)/4 = 28 A².
TEST(DemandGatherer, current_is_merged_by_its_square) {
  DemandGatherer gatherer("wheel", 4.0, kGrid);
  gatherer.add(1.0, 0.0, 10.0, -2.0);
  gatherer.add(3.0, 0.0, 10.0, 6.0);
  const WheelDemand demand = gatherer.finish();
  ASSERT_EQ(demand.bins.size(), 1U);
  EXPECT_NEAR(demand.bins[0].current_rms_A, std::sqrt(28.0), 1e-14);
  ASSERT_EQ(demand.points.size(), 2U);
  EXPECT_NEAR(demand.points[0].current_A, -2.0, 1e-12);
  EXPECT_NEAR(demand.points[1].current_A, 6.0, 1e-12);
}

// A braking current of 4 A must stay a braking current in a bin, in a point and in merged rows.
TEST(DemandGatherer, current_against_the_motion_brakes) {
  DemandGatherer gatherer("wheel", 1.0, kGrid);
  for (int i = 0; i < 200; ++i) {
    gatherer.add(0.01, 0.0, -100.0, 4.0);
  }
  gatherer.add_alone(1.0, 0.0, 100.0, -4.0);
  const WheelDemand demand = gatherer.finish();
  for (const LoadBin& bin : demand.bins) {
    EXPECT_NEAR(bin.current_rms_A, 4.0, 1e-12);
    EXPECT_NEAR(bin.current_along_motion_A, -4.0, 1e-12);
  }
  EXPECT_NEAR(demand.bins.front().current_mean_A, 4.0, 1e-12);
  ASSERT_FALSE(demand.points.empty());
  for (const LoadPoint& point : demand.points) {
    EXPECT_NEAR(point.current_A, -4.0, 0.05);
    EXPECT_GE(point.speed_rad_per_s, 0.0);
  }
}

TEST(DemandGatherer, a_separate_segment_ends_the_bin_before_it) {
  DemandGatherer gatherer("wheel", 4.0, kGrid);
  gatherer.add(1.0, 0.1, 10.0);
  gatherer.add_alone(0.5, -0.1234, -50.0);
  gatherer.add(1.0, 0.1, 10.0);
  const WheelDemand demand = gatherer.finish();
  ASSERT_EQ(demand.bins.size(), 3U);
  EXPECT_EQ(demand.bins[1].torque_mean_Nm, -0.1234);
  EXPECT_EQ(demand.bins[1].duration_s, 0.5);
  EXPECT_EQ(demand.bins[2].acceleration_rad_per_s2, 0.0);
  EXPECT_TRUE(std::ranges::any_of(demand.points, [](const LoadPoint& each) { return each.torque_Nm == 0.1234 && each.time_s == 0.5; }));
}

// For any range of loads the number of points is bounded. The points cover the whole time and never have less load than the input.
TEST(DemandGatherer, loads_without_bound_make_no_points_without_bound) {
  base::Random random(5, 0);
  DemandGatherer gatherer("wheel", 1e9, kGrid);
  std::vector<LoadPoint> given;
  for (int i = 0; i < 200'000; ++i) {
    const double scale = std::pow(10.0, 9.0 * random.uniform() - 3.0);
    given.push_back({scale * random.uniform(), 1e4 * random.uniform(), 0.0, 0.5 + random.uniform()});
    gatherer.add(given.back().time_s, given.back().torque_Nm, given.back().speed_rad_per_s);
  }
  const WheelDemand demand = gatherer.finish();
  EXPECT_LE(demand.points.size(), DemandGatherer::kMostCells);
  EXPECT_GT(demand.points.size(), DemandGatherer::kMostCells / 8);
  const auto time_beyond_s = [](const std::vector<LoadPoint>& points, double torque_Nm, double speed_rad_per_s) {
    return std::accumulate(points.begin(), points.end(), 0.0, [&](double sum_s, const LoadPoint& each) {
      return sum_s + (each.torque_Nm >= torque_Nm && each.speed_rad_per_s >= speed_rad_per_s ? each.time_s : 0.0);
    });
  };
  EXPECT_NEAR(time_beyond_s(demand.points, 0.0, 0.0), time_beyond_s(given, 0.0, 0.0), 1e-4);
  for (int i = 0; i < 20; ++i) {
    const LoadPoint& at = given[static_cast<std::size_t>(random.uniform() * 2e5)];
    EXPECT_GE(time_beyond_s(demand.points, at.torque_Nm, at.speed_rad_per_s),
              time_beyond_s(given, at.torque_Nm, at.speed_rad_per_s) * (1.0 - 1e-9));
  }
}

}  // namespace
}  // namespace heatsoak::duty
