// The promise of a derating, checked on fresh motors over many seeds.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "base/binomial_bound.h"
#include "guarded_motor.h"

namespace heatsoak::derate {
namespace {

constexpr int kFresh = 2000;
constexpr std::uint64_t kFreshSeed = 1'000'003;

/// Returns how many fresh motors exceed a limit with this derating.
int fresh_over(const Derating& derating) {
  GuaranteeOptions fresh = derating.options.guarantee;
  fresh.samples = kFresh;
  fresh.seed = kFreshSeed;
  return check(ecx_32(), derating.rules.limits, derating.uses, fresh, 0).over;
}

/// Derates one motor with `seeds` seeds. The share of these deratings that break their promise on fresh motors must be consistent with the
/// stated certainty. Draws: the fewest with which one motor may be over its limit, so that the factor is not that of the hottest motor.
void expect_promise_holds(int seeds) {
  DerateOptions options;
  options.guarantee.required_share = 0.9;
  options.guarantee.samples = 46;
  ASSERT_EQ(most_over(options.guarantee), 1);
  std::vector<Derating> made;
  for (int seed = 1; seed <= seeds; ++seed) {
    options.guarantee.seed = static_cast<std::uint64_t>(seed);
    made.push_back(derate(ecx_32(), twente(), options));
  }
  std::ranges::sort(made, {}, [](const Derating& each) { return each.observer.heat_safety_factor(); });
  // A larger factor leaves fewer motors over their limits, so the deratings that break the promise come first.
  const double permitted = (1.0 - options.guarantee.required_share) * kFresh;
  const auto kept = std::ranges::partition_point(made, [&](const Derating& each) { return fresh_over(each) > permitted; });
  const double broken = static_cast<double>(kept - made.begin());
  constexpr double kConfidence = 0.999;
  EXPECT_LE(1.0 - base::upper_bound_share(seeds - broken, seeds, kConfidence), 1.0 - kCertainty_share) << broken << " of " << seeds;
  // The promise is no empty one: the factors are close to those at which it breaks.
  EXPECT_GT(fresh_over(made.front()), 0.5 * permitted);
  EXPECT_GT(fresh_over(made[made.size() / 2]), 0.1 * permitted);
}

TEST(FreshMotors, KeepTheirLimitsAsOftenAsPromised) { expect_promise_holds(12); }

TEST(FreshMotors, KeepTheirLimitsAsOftenAsPromisedOverManySeeds) { expect_promise_holds(100); }

}  // namespace
}  // namespace heatsoak::derate
