// Search for the smallest sufficient safety factor, for checks whose answer is known.
#include "derate/smallest_factor.h"

#include <gtest/gtest.h>

#include <optional>
#include <random>

namespace heatsoak::derate {
namespace {

struct Found {
  std::optional<double> ratio;
  int checks = 0;
  double most_checked_ratio = 0.0;
};

/// Searches with a check that accepts from `enough_ratio`; `expected(factor)` is its estimate.
template <class Expected>
Found search(const FactorGrid& grid, double enough_ratio, const Expected& expected) {
  Found found;
  found.ratio = smallest_factor(grid, [&](double ratio) {
    ++found.checks;
    found.most_checked_ratio = std::max(found.most_checked_ratio, ratio);
    return TriedFactor{ratio >= enough_ratio, expected(ratio)};
  });
  return found;
}

TEST(SmallestFactor, IsSufficientToOnePercent) {
  std::mt19937 engine(1);
  for (int i = 0; i < 500; ++i) {
    const FactorGrid grid{1.0, 16.0, std::uniform_real_distribution(1.02, 2.0)(engine)};
    const double enough_ratio = std::uniform_real_distribution(0.9, 16.0)(engine);
    const Found found = search(grid, enough_ratio, [](double) { return std::nullopt; });
    ASSERT_TRUE(found.ratio) << enough_ratio;
    EXPECT_GE(*found.ratio, enough_ratio);
    EXPECT_LE(*found.ratio, std::max(1.0, 1.0101 * enough_ratio));
  }
}

// Right, biased, wild and missing estimates change the number of checks only.
TEST(SmallestFactor, DoesNotDependOnTheExpectedFactors) {
  std::mt19937 engine(2);
  int checks_plain = 0;
  int checks_expected = 0;
  for (int i = 0; i < 500; ++i) {
    const FactorGrid grid{std::uniform_real_distribution(1.0, 3.0)(engine), 16.0, 1.5};
    const double enough_ratio = std::uniform_real_distribution(0.9, i % 2 == 0 ? 15.9 : 3.0)(engine);
    const Found plain = search(grid, enough_ratio, [](double) { return std::nullopt; });
    const Found exact = search(grid, enough_ratio, [&](double) { return enough_ratio; });
    const Found biased = search(grid, enough_ratio, [&](double ratio) { return 0.7 * enough_ratio + 0.3 * ratio; });
    const Found wild = search(grid, enough_ratio, [&](double) { return std::uniform_real_distribution(-1.0, 40.0)(engine); });
    for (const Found& each : {exact, biased, wild}) {
      EXPECT_EQ(each.ratio, plain.ratio) << enough_ratio;
      EXPECT_LE(each.most_checked_ratio, plain.most_checked_ratio) << "a far too large factor may not have a table at all";
      EXPECT_LE(each.checks, plain.checks + 5);
    }
    checks_plain += plain.checks;
    checks_expected += exact.checks;
  }
  EXPECT_LT(checks_expected, 0.6 * checks_plain);
}

TEST(SmallestFactor, IsNothingIfTheLargestIsNotEnough) {
  for (const std::optional<double> expected_ratio : {std::optional<double>(), std::optional(2.0), std::optional(30.0)}) {
    const Found found = search({1.0, 4.0, 1.5}, 4.01, [&](double) { return expected_ratio; });
    EXPECT_FALSE(found.ratio);
    EXPECT_EQ(found.most_checked_ratio, 4.0);
  }
  EXPECT_EQ(search({8.0, 4.0, 1.5}, 3.0, [](double) { return std::nullopt; }).ratio, 4.0) << "a search that begins above its end";
}

}  // namespace
}  // namespace heatsoak::derate
