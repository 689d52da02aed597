// Exact bounds of a probability, compared with their definition and closed forms.
#include "base/binomial_bound.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

namespace heatsoak::base {
namespace {

TEST(BinomialBound, WithoutAHitIsTheClosedForm) {
  for (const double draws : {1.0, 10.0, 59.0, 500.0}) {
    EXPECT_NEAR(upper_bound_share(0.0, draws, 0.95), 1.0 - std::pow(0.05, 1.0 / draws), 1e-12);
  }
  EXPECT_EQ(upper_bound_share(7.0, 7.0, 0.95), 1.0);
}

// Definition: if the probability equals the bound, so few hits have a chance of 5 %.
TEST(BinomialBound, LeavesAChanceOfFivePercent) {
  constexpr int kDraws = 40;
  for (int over = 0; over < kDraws; over += 7) {
    const double p = upper_bound_share(over, kDraws, 0.95);
    double chance = 0.0;
    for (int k = 0; k <= over; ++k) {
      chance += std::exp(std::lgamma(kDraws + 1.0) - std::lgamma(k + 1.0) - std::lgamma(kDraws - k + 1.0) + k * std::log(p) +
                         (kDraws - k) * std::log1p(-p));
    }
    EXPECT_NEAR(chance, 0.05, 1e-9);
  }
}

TEST(BinomialBound, FewestDrawsThatKeepALimit) {
  EXPECT_EQ(draws_needed(0.0, 0.05, 0.95), 59);  // 0.95^59 < 0.05 < 0.95^58
  EXPECT_EQ(draws_needed(0.05, 0.05, 0.95), std::nullopt);
  const long needed = draws_needed(0.02, 0.05, 0.95).value();
  EXPECT_LE(upper_bound_share(std::ceil(0.02 * static_cast<double>(needed)), static_cast<double>(needed), 0.95), 0.05);
}

TEST(BinomialBound, FewestDrawsAreTheFirstThatSuffice) {
  for (const double limit_share : {0.5, 0.1, 0.05, 0.001}) {
    const auto fewest = static_cast<double>(fewest_draws(limit_share, 0.95));
    EXPECT_LE(upper_bound_share(0.0, fewest, 0.95), limit_share * (1.0 + 1e-9));
    EXPECT_GT(upper_bound_share(0.0, fewest - 1.0, 0.95), limit_share);
  }
}

}  // namespace
}  // namespace heatsoak::base
