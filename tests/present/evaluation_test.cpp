// Text and numbers of an evaluation.
#include "present/evaluation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/binomial_bound.h"
#include "present/verdict_topic.h"
#include "select/decision.h"

namespace heatsoak::present {
namespace {

using testing::HasSubstr;

select::MotorEvaluation heating_to(double peak_C) {
  select::MotorEvaluation motor;
  motor.winding_limit_C = 125.0;
  for (int i = 0; i <= 800; ++i) {
    motor.curves.time_s.push_back(i);
    motor.curves.winding_C.push_back(25.0 + (peak_C - 25.0) * i / 800.0);
  }
  return motor;
}

TEST(Sparkline, rises_with_the_winding_from_ambient_to_limit) {
  EXPECT_EQ(sparkline(heating_to(125.0), 25.0), "▁▂▃▄▅▆▇█");
  EXPECT_EQ(sparkline(heating_to(25.0), 25.0), "▁▁▁▁▁▁▁▁");
  EXPECT_EQ(sparkline(heating_to(1000.0), 25.0), "████████");
  EXPECT_EQ(sparkline(select::MotorEvaluation{}, 25.0), "");
}

select::MotorEvaluation sampled(double probability, select::Interval95 interval, int samples) {
  select::MotorEvaluation motor;
  motor.samples = samples;
  motor.probability_over_limit = probability;
  motor.probability_interval = interval;
  return motor;
}

TEST(SamplesNeeded, nothing_where_the_interval_covers_no_threshold) {
  EXPECT_FALSE(select::samples_needed(sampled(0.01, {0.005, 0.02}, 500), {0.0, 0.01}, false));
  EXPECT_FALSE(select::samples_needed(sampled(0.2, {0.17, 0.24}, 500), {0.0, 0.01}, false));
  EXPECT_FALSE(select::samples_needed(sampled(0.04, {0.02, 0.06}, 0), {0.0, 0.01}, false)) << "nominal values alone decide";
}

// With the same share and the error of that look, the returned number of samples decides, and one less does not.
TEST(SamplesNeeded, is_the_smallest_number_that_decides) {
  for (const auto& [share, is_drawn] : {std::pair(0.04, false), std::pair(0.07, false), std::pair(0.03, true), std::pair(0.08, true)}) {
    const int per_draw = is_drawn ? 8 : 1;
    const std::optional<int> needed = select::samples_needed(sampled(share, {0.02, 0.11}, 600), {0.0, 0.01}, is_drawn);
    ASSERT_TRUE(needed);
    EXPECT_EQ(*needed % per_draw, 0);
    const auto decides = [&, share = share, is_drawn = is_drawn](int draws) {
      const base::ShareInterval then = base::share_interval(share, draws, select::error_share(draws, is_drawn));
      return then.low > select::kMarginalProbability || then.high <= select::kMarginalProbability;
    };
    EXPECT_TRUE(decides(*needed / per_draw)) << share;
    EXPECT_FALSE(decides(*needed / per_draw - 1)) << share;
  }
}

// (1 - 0.05)^n is at most the error of the first look, 0.025, from n = 72 on.
TEST(SamplesNeeded, without_a_hit_it_is_that_of_the_binomial_law) {
  EXPECT_EQ(*select::samples_needed(sampled(0.0, {0.0, 0.31}, 80), {0.0, 0.0}, true), 72 * 8);
}

// The program doubles the first number at most five times. Two further looks remain for users who request more.
TEST(SamplesNeeded, all_looks_together_err_with_5_percent_at_most) {
  for (const auto& [first, is_drawn] : {std::pair(75, true), std::pair(500, false)}) {
    double total = 0.0;
    for (int look = 0; look < 8; ++look) {
      total += select::error_share(first << look, is_drawn);
    }
    EXPECT_LE(total, 0.05 + 1e-12);
    EXPECT_GE(total, 0.049);
  }
}

TEST(SamplesNeeded, majority_counts_where_the_duty_is_drawn) {
  EXPECT_FALSE(select::samples_needed(sampled(0.48, {0.4, 0.55}, 80), {0.0, 0.01}, false));
  EXPECT_TRUE(select::samples_needed(sampled(0.48, {0.4, 0.55}, 80), {0.0, 0.01}, true));
}

TEST(SamplesNeeded, demand_that_is_missed_counts_too) {
  select::MotorEvaluation motor = sampled(0.0, {0.0, 0.01}, 500);
  motor.short_probability = 0.05;
  EXPECT_TRUE(select::samples_needed(motor, {0.03, 0.07}, false));
}

TEST(VerdictTopic, states_the_thresholds_that_decide) {
  const std::vector<VerdictMeaning> all = verdict_meanings();
  ASSERT_EQ(all.size(), 4U);
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i].verdict, static_cast<select::Verdict>(i));
  }
  EXPECT_THAT(all[0].meaning, HasSubstr("At most 5 % of the samples exceed a limit"));
  EXPECT_THAT(all[2].meaning, HasSubstr("more than 50 % of the samples"));
}

}  // namespace
}  // namespace heatsoak::present
