// Half widths of intervals of a normal distribution belong to the levels that are printed beside them.
#include "estimation/interval.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/confidence.h"

namespace heatsoak::estimation {
namespace {

TEST(Interval, HasThePrintedLevel) {
  EXPECT_NEAR(std::erf(kInterval_sd / std::numbers::sqrt2), base::kInterval_share, 1e-6);
  EXPECT_EQ(base::level_text(base::kInterval_share), "95 %");
  EXPECT_EQ(base::level_text(base::kBoundConfidence_share), "97.5 %");
}

}  // namespace
}  // namespace heatsoak::estimation
