#include "base/parameter_value.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/random.h"
#include "support/seed_rate.h"

namespace heatsoak::base {
namespace {

ParameterValue tolerance(double value, double share) {
  ParameterValue parameter;
  parameter.value = value;
  parameter.spread = Spread{Spread::Kind::tolerance, value * (1.0 - share), value * (1.0 + share), true};
  return parameter;
}
ParameterValue range(double value, double low, double high, bool by_ratio) {
  ParameterValue parameter;
  parameter.value = value;
  parameter.spread = Spread{Spread::Kind::range, low, high, by_ratio};
  return parameter;
}

/// Returns the probability of a value below `bound`, from quantiles at evenly distributed probabilities.
double share_below(const ParameterValue& parameter, double bound) {
  constexpr int kCells = 20000;
  int below = 0;
  for (int i = 0; i < kCells; ++i) {
    below += parameter.quantile((i + 0.5) / kCells) < bound ? 1 : 0;
  }
  return static_cast<double>(below) / kCells;
}

const std::vector<ParameterValue> kParameterValues{
    tolerance(1.07, 0.1),           tolerance(30.0, 0.9),         range(3.8, 2.2, 6.0, true), range(0.25, 0.15, 0.45, true),
    range(25.0, 20.0, 32.0, false), range(0.0, -5.0, 3.0, false), range(2.0, 2.0, 3.0, true), range(2.0, 1.0, 2.0, true)};

TEST(ParameterQuantile, without_spread_is_the_value) {
  ParameterValue parameter;
  parameter.value = 4.2;
  for (const double uniform : {1e-12, 0.3, 0.5, 1.0 - 1e-12}) {
    EXPECT_EQ(parameter.quantile(uniform), 4.2);
  }
}

TEST(ParameterQuantile, median_is_the_value) {
  for (const ParameterValue& parameter : kParameterValues) {
    EXPECT_NEAR(parameter.quantile(0.5), parameter.value, 1e-14 * std::abs(parameter.value) + 1e-15);
  }
}

TEST(ParameterQuantile, never_leaves_the_bounds_and_reaches_them) {
  for (const ParameterValue& parameter : kParameterValues) {
    const double width = parameter.spread->high - parameter.spread->low;
    Random random(1001, 0);
    for (int i = 0; i < 10000; ++i) {
      const double value = parameter.quantile(random.uniform());
      EXPECT_GE(value, parameter.spread->low - 1e-12 * width);
      EXPECT_LE(value, parameter.spread->high + 1e-12 * width);
    }
    EXPECT_NEAR(parameter.quantile(1e-9), parameter.spread->low, 1e-6 * width);
    EXPECT_NEAR(parameter.quantile(1.0 - 1e-9), parameter.spread->high, 1e-6 * width);
  }
}

TEST(ParameterQuantile, rises) {
  for (const ParameterValue& parameter : kParameterValues) {
    double before = parameter.quantile(1e-6);
    for (double uniform = 0.001; uniform < 1.0; uniform += 0.001) {
      const double value = parameter.quantile(uniform);
      EXPECT_GE(value, before);
      before = value;
    }
  }
}

// A normal distribution with 95 % within the tolerance has half of it as standard deviation. Truncated at two standard deviations, one
// holds 0.6827/0.9545 = 71.52 % of the draws. Half a standard deviation holds 38.29/95.45 = 40.12 %.
TEST(ParameterQuantile, tolerance_is_two_standard_deviations) {
  const ParameterValue parameter = tolerance(100.0, 0.1);
  EXPECT_NEAR(share_below(parameter, 105.0) - share_below(parameter, 95.0), 0.7152, 2e-4);
  EXPECT_NEAR(share_below(parameter, 102.5) - share_below(parameter, 97.5), 0.4012, 2e-4);
  EXPECT_NEAR(share_below(parameter, 100.0), 0.5, 1e-4);
}

TEST(ParameterQuantile, tolerance_is_symmetric) {
  const ParameterValue parameter = tolerance(100.0, 0.1);
  for (double uniform = 0.01; uniform < 0.5; uniform += 0.01) {
    EXPECT_NEAR(parameter.quantile(uniform) + parameter.quantile(1.0 - uniform), 200.0, 1e-9);
  }
}

TEST(ParameterQuantile, range_is_as_likely_above_as_below_and_every_ratio_alike) {
  const ParameterValue parameter = range(3.8, 2.2, 6.0, true);
  EXPECT_NEAR(share_below(parameter, 3.8), 0.5, 1e-4);
  EXPECT_NEAR(share_below(parameter, std::sqrt(2.2 * 3.8)), 0.25, 1e-4);
  EXPECT_NEAR(share_below(parameter, std::sqrt(3.8 * 6.0)), 0.75, 1e-4);
}

TEST(ParameterQuantile, range_of_temperatures_takes_every_difference_alike) {
  const ParameterValue parameter = range(25.0, 20.0, 32.0, false);
  EXPECT_NEAR(share_below(parameter, 22.5), 0.25, 1e-4);
  EXPECT_NEAR(share_below(parameter, 25.0), 0.5, 1e-4);
  EXPECT_NEAR(share_below(parameter, 28.5), 0.75, 1e-4);
}

TEST(Origin, names_are_read_back) {
  for (const Origin origin : {Origin::measured, Origin::datasheet, Origin::third_party, Origin::derived, Origin::estimated}) {
    EXPECT_EQ(origin_from(to_string(origin)), origin);
  }
  EXPECT_FALSE(origin_from("hearsay").has_value());
  EXPECT_FALSE(origin_from("").has_value());
}

// --- random numbers ---------------------------------------------------------------------------------------

TEST(Random, is_uniform_in_the_open_interval) {
  // 19 degrees of freedom: a share of 5 % of all seeds is above 30.14, and one of 5 % is below 10.12.
  const auto chi_squared = [](std::uint64_t seed) {
    Random random(seed, 2);
    std::vector<int> count(20);
    for (int i = 0; i < 20000; ++i) {
      const double uniform = random.uniform();
      EXPECT_GT(uniform, 0.0);
      EXPECT_LT(uniform, 1.0);
      ++count[static_cast<std::size_t>(20.0 * uniform)];
    }
    double sum = 0.0;
    for (const int each : count) {
      sum += (each - 1000.0) * (each - 1000.0) / 1000.0;
    }
    return sum;
  };
  EXPECT_TRUE(holds_for_share(0.95, 100, [&](std::uint64_t seed) { return chi_squared(seed) < 30.14; }));
  EXPECT_TRUE(holds_for_share(0.95, 100, [&](std::uint64_t seed) { return chi_squared(seed) > 10.12; }));
}

TEST(Random, neighbouring_seeds_and_streams_are_unrelated) {
  // The correlation of unrelated numbers is within 1.96/√n for 95 % of the seeds.
  for (const std::uint64_t stream : {0U, 1U, 2U, 3U}) {
    const auto is_unrelated = [stream](std::uint64_t seed, std::uint64_t other_seed, std::uint64_t other_stream) {
      Random a(seed, stream);
      Random b(other_seed, other_stream);
      double correlation = 0.0;
      constexpr int kDraws = 5000;
      for (int i = 0; i < kDraws; ++i) {
        const double x = a.uniform() - 0.5;
        correlation += 12.0 * x * (b.uniform() - 0.5) / kDraws;
      }
      return std::abs(correlation) < 1.96 / std::sqrt(kDraws);
    };
    EXPECT_TRUE(holds_for_share(0.95, 50, [&](std::uint64_t seed) { return is_unrelated(seed, seed, stream + 1); })) << stream;
    EXPECT_TRUE(holds_for_share(0.95, 50, [&](std::uint64_t seed) { return is_unrelated(seed, seed + 1, stream); })) << stream;
  }
}

TEST(Random, seed_and_stream_decide_all_numbers) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Random a(seed, 6);
    Random b(seed, 6);
    for (int i = 0; i < 100; ++i) {
      EXPECT_EQ(a.uniform(), b.uniform());
    }
  }
}

}  // namespace
}  // namespace heatsoak::base
