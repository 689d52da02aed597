#include "base/parameter_value.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/random.h"

namespace heatsoak::base {
namespace {

ParameterValue tolerance(double value, double share) {
  ParameterValue figure;
  figure.value = value;
  figure.spread = Spread{Spread::Kind::tolerance, value * (1.0 - share), value * (1.0 + share), true};
  return figure;
}
ParameterValue range(double value, double low, double high, bool by_ratio) {
  ParameterValue figure;
  figure.value = value;
  figure.spread = Spread{Spread::Kind::range, low, high, by_ratio};
  return figure;
}

/// Returns the share of draws below `bound`.
double share_below(const ParameterValue& figure, double bound, int draws = 200000) {
  Random random(1000, 0);
  int below = 0;
  for (int i = 0; i < draws; ++i) {
    below += figure.quantile(random.uniform()) < bound ? 1 : 0;
  }
  return static_cast<double>(below) / draws;
}

const std::vector<ParameterValue> kParameterValues{
    tolerance(1.07, 0.1),           tolerance(30.0, 0.9),         range(3.8, 2.2, 6.0, true), range(0.25, 0.15, 0.45, true),
    range(25.0, 20.0, 32.0, false), range(0.0, -5.0, 3.0, false), range(2.0, 2.0, 3.0, true), range(2.0, 1.0, 2.0, true)};

TEST(ParameterQuantile, without_spread_is_the_value) {
  ParameterValue figure;
  figure.value = 4.2;
  for (const double uniform : {1e-12, 0.3, 0.5, 1.0 - 1e-12}) {
    EXPECT_EQ(figure.quantile(uniform), 4.2);
  }
}

TEST(ParameterQuantile, median_is_the_value) {
  for (const ParameterValue& figure : kParameterValues) {
    EXPECT_NEAR(figure.quantile(0.5), figure.value, 1e-14 * std::abs(figure.value) + 1e-15);
  }
}

TEST(ParameterQuantile, never_leaves_the_bounds_and_reaches_them) {
  for (const ParameterValue& figure : kParameterValues) {
    const double width = figure.spread->high - figure.spread->low;
    Random random(1001, 0);
    for (int i = 0; i < 10000; ++i) {
      const double value = figure.quantile(random.uniform());
      EXPECT_GE(value, figure.spread->low - 1e-12 * width);
      EXPECT_LE(value, figure.spread->high + 1e-12 * width);
    }
    EXPECT_NEAR(figure.quantile(1e-9), figure.spread->low, 1e-6 * width);
    EXPECT_NEAR(figure.quantile(1.0 - 1e-9), figure.spread->high, 1e-6 * width);
  }
}

TEST(ParameterQuantile, rises) {
  for (const ParameterValue& figure : kParameterValues) {
    double before = figure.quantile(1e-6);
    for (double uniform = 0.001; uniform < 1.0; uniform += 0.001) {
      const double value = figure.quantile(uniform);
      EXPECT_GE(value, before);
      before = value;
    }
  }
}

// A normal distribution with 95 % within the tolerance has half of it as standard deviation. Truncated at two standard deviations, one
// holds 0.6827/0.9545 = 71.52 % of the draws. Half a standard deviation holds 38.29/95.45 = 40.12 %.
TEST(ParameterQuantile, tolerance_is_two_standard_deviations) {
  const ParameterValue figure = tolerance(100.0, 0.1);
  EXPECT_NEAR(share_below(figure, 105.0) - share_below(figure, 95.0), 0.7152, 0.005);
  EXPECT_NEAR(share_below(figure, 102.5) - share_below(figure, 97.5), 0.4012, 0.005);
  EXPECT_NEAR(share_below(figure, 100.0), 0.5, 0.005);
}

TEST(ParameterQuantile, tolerance_is_symmetric) {
  const ParameterValue figure = tolerance(100.0, 0.1);
  for (double uniform = 0.01; uniform < 0.5; uniform += 0.01) {
    EXPECT_NEAR(figure.quantile(uniform) + figure.quantile(1.0 - uniform), 200.0, 1e-9);
  }
}

TEST(ParameterQuantile, range_is_as_likely_above_as_below_and_every_ratio_alike) {
  const ParameterValue figure = range(3.8, 2.2, 6.0, true);
  EXPECT_NEAR(share_below(figure, 3.8), 0.5, 0.005);
  EXPECT_NEAR(share_below(figure, std::sqrt(2.2 * 3.8)), 0.25, 0.005);
  EXPECT_NEAR(share_below(figure, std::sqrt(3.8 * 6.0)), 0.75, 0.005);
}

TEST(ParameterQuantile, range_of_temperatures_takes_every_difference_alike) {
  const ParameterValue figure = range(25.0, 20.0, 32.0, false);
  EXPECT_NEAR(share_below(figure, 22.5), 0.25, 0.005);
  EXPECT_NEAR(share_below(figure, 25.0), 0.5, 0.005);
  EXPECT_NEAR(share_below(figure, 28.5), 0.75, 0.005);
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
  Random random(1, 2);
  std::vector<int> count(20);
  for (int i = 0; i < 200000; ++i) {
    const double uniform = random.uniform();
    ASSERT_GT(uniform, 0.0);
    ASSERT_LT(uniform, 1.0);
    ++count[static_cast<std::size_t>(20.0 * uniform)];
  }
  double chi_squared = 0.0;
  for (const int each : count) {
    chi_squared += (each - 10000.0) * (each - 10000.0) / 10000.0;
  }
  EXPECT_LT(chi_squared, 43.8) << "19 degrees of freedom, 0.1 %";
}

TEST(Random, neighbouring_seeds_and_streams_are_unrelated) {
  for (const auto& [seed, stream] : {std::pair{0, 1}, {1, 0}, {1, 1}, {2, 3}}) {
    Random a(static_cast<std::uint64_t>(seed), static_cast<std::uint64_t>(stream));
    Random b(static_cast<std::uint64_t>(seed), static_cast<std::uint64_t>(stream) + 1);
    Random c(static_cast<std::uint64_t>(seed) + 1, static_cast<std::uint64_t>(stream));
    double with_b = 0.0;
    double with_c = 0.0;
    constexpr int kDraws = 20000;
    for (int i = 0; i < kDraws; ++i) {
      const double x = a.uniform() - 0.5;
      with_b += 12.0 * x * (b.uniform() - 0.5) / kDraws;
      with_c += 12.0 * x * (c.uniform() - 0.5) / kDraws;
    }
    EXPECT_LT(std::abs(with_b), 4.0 / std::sqrt(kDraws));
    EXPECT_LT(std::abs(with_c), 4.0 / std::sqrt(kDraws));
  }
}

TEST(Random, seed_and_stream_decide_all_numbers) {
  Random a(5, 6);
  Random b(5, 6);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(a.uniform(), b.uniform());
  }
}

}  // namespace
}  // namespace heatsoak::base
