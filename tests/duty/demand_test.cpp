#include "duty/demand.h"

#include <gtest/gtest.h>

namespace heatsoak {
namespace {

const DemandGatherer::Grid kGrid{};

// 0.1 N m at 100 rad/s for 1 s, then −0.05 N m at 40 rad/s for 3 s: (10·1 − 2·3)/4 = 1 W.
TEST(DemandGatherer, power_is_the_mean_of_the_products) {
  DemandGatherer gatherer("wheel", 4.0, kGrid);
  gatherer.add(1.0, 0.1, 100.0);
  gatherer.add(3.0, -0.05, 40.0);
  const WheelDemand demand = gatherer.finish();
  ASSERT_EQ(demand.bins.size(), 1U);
  EXPECT_NEAR(demand.bins[0].power_mean_W, 1.0, 1e-14);
  EXPECT_NEAR(constant_bin(2.0, -0.05, 40.0, 0.0).power_mean_W, -2.0, 1e-15);
}

// A triangle of speed between −30 and 30 rad/s with 60 rad/s per second up and down, a thousand steps a second.
TEST(DemandGatherer, acceleration_is_the_mean_of_its_magnitude_through_reversals_and_across_bins) {
  DemandGatherer gatherer("wheel", 0.7, kGrid);
  for (int i = 0; i < 7000; ++i) {
    const int phase = i % 2000;
    gatherer.add(1e-3, 0.0, phase < 1000 ? -30.0 + 0.06 * phase : 30.0 - 0.06 * (phase - 1000));
  }
  const WheelDemand demand = gatherer.finish();
  ASSERT_EQ(demand.bins.size(), 10U);
  for (std::size_t i = 0; i < demand.bins.size(); ++i) {
    // The very first moment has none before it.
    EXPECT_NEAR(demand.bins[i].acceleration_rad_per_s2, i == 0 ? 60.0 * 699.0 / 700.0 : 60.0, 1e-9) << i;
  }
}

}  // namespace
}  // namespace heatsoak
