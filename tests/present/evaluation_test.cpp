// The words and numbers of an evaluation.
#include "present/evaluation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "present/verdict_topic.h"
#include "select/decision.h"

namespace heatsoak::present {
namespace {

using testing::HasSubstr;

MotorEvaluation heating_to(double peak_C) {
  MotorEvaluation motor;
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
  EXPECT_EQ(sparkline(MotorEvaluation{}, 25.0), "");
}

MotorEvaluation sampled(double probability, Interval95 interval, int samples) {
  MotorEvaluation motor;
  motor.samples = samples;
  motor.probability_over_limit = probability;
  motor.probability_interval = interval;
  return motor;
}

TEST(SamplesNeeded, nothing_where_the_interval_covers_no_threshold) {
  EXPECT_FALSE(samples_needed(sampled(0.01, {0.005, 0.02}, 500), {0.0, 0.01}, false));
  EXPECT_FALSE(samples_needed(sampled(0.2, {0.17, 0.24}, 500), {0.0, 0.01}, false));
  EXPECT_FALSE(samples_needed(sampled(0.04, {0.02, 0.06}, 0), {0.0, 0.01}, false)) << "nominal values alone decide";
}

// The half width falls with the root of the number of samples: to shrink 0.02 to 0.01 takes four times as many.
TEST(SamplesNeeded, follows_the_root_of_the_number_of_samples) {
  EXPECT_NEAR(*samples_needed(sampled(0.04, {0.02, 0.06}, 500), {0.0, 0.01}, false), 2000, 1);
  EXPECT_NEAR(*samples_needed(sampled(0.07, {0.03, 0.11}, 500), {0.0, 0.01}, false), 2000, 1);
}

TEST(SamplesNeeded, majority_counts_where_the_duty_is_drawn) {
  EXPECT_FALSE(samples_needed(sampled(0.48, {0.4, 0.55}, 80), {0.0, 0.01}, false));
  EXPECT_TRUE(samples_needed(sampled(0.48, {0.4, 0.55}, 80), {0.0, 0.01}, true));
}

TEST(SamplesNeeded, demand_that_is_missed_counts_too) {
  MotorEvaluation motor = sampled(0.0, {0.0, 0.01}, 500);
  motor.short_probability = 0.05;
  EXPECT_TRUE(samples_needed(motor, {0.03, 0.07}, false));
}

TEST(VerdictTopic, states_the_thresholds_that_decide) {
  const std::vector<VerdictMeaning> all = verdict_meanings();
  ASSERT_EQ(all.size(), 4U);
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i].verdict, static_cast<Verdict>(i));
  }
  EXPECT_THAT(all[0].meaning, HasSubstr("At most 5 % of the samples exceed a limit"));
  EXPECT_THAT(all[2].meaning, HasSubstr("more than 50 % of the samples"));
}

}  // namespace
}  // namespace heatsoak::present
