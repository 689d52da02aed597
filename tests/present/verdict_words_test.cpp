// Verdicts in words, and the samples that an undecided one needs.
#include "present/verdict_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "base/binomial_bound.h"
#include "evaluation_answers.h"
#include "present/verdict_topic.h"
#include "select/decision.h"

namespace heatsoak::present {
namespace {

using testing::HasSubstr;

TEST(SamplesNeeded, nothing_where_the_interval_covers_no_threshold) {
  EXPECT_FALSE(select::samples_needed(sampled(0.01, {0.005, 0.02}, 500), false));
  EXPECT_FALSE(select::samples_needed(sampled(0.2, {0.17, 0.24}, 500), false));
  EXPECT_FALSE(select::samples_needed(sampled(0.04, {0.02, 0.06}, 0), false)) << "nominal values alone decide";
}

// With the same share and the error of that look, the returned number of samples decides, and one less does not.
TEST(SamplesNeeded, is_the_smallest_number_that_decides) {
  for (const auto& [share, is_drawn] : {std::pair(0.04, false), std::pair(0.07, false), std::pair(0.03, true), std::pair(0.08, true)}) {
    const int per_draw = is_drawn ? 8 : 1;
    const std::optional<int> needed = select::samples_needed(sampled(share, {0.02, 0.11}, 600), is_drawn);
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
  EXPECT_EQ(*select::samples_needed(sampled(0.0, {0.0, 0.31}, 80), true), 72 * 8);
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

// 500 samples and 75 games, doubled five times; half of 5 % for the first look, a seventh of the other half for each later one.
TEST(VerdictTopic, states_the_numbers_of_the_decision) {
  std::string details;
  for (const UndecidedDetail& each : undecided_details()) {
    details += each.words + "\n";
  }
  EXPECT_THAT(undecided_meaning(), HasSubstr("5 %, or 50 % on a duty that is drawn"));
  EXPECT_THAT(details,
              testing::AllOf(HasSubstr("up to 5 times: to 16000, or to 2400 games"), HasSubstr("(less than 20 %)"),
                             HasSubstr("may err with 2.5 %, each later one with 0.36 %"), HasSubstr("a probability of at most 5 %")));
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

TEST(SamplesNeeded, majority_counts_where_the_duty_is_drawn) {
  EXPECT_FALSE(select::samples_needed(sampled(0.48, {0.4, 0.55}, 80), false));
  EXPECT_TRUE(select::samples_needed(sampled(0.48, {0.4, 0.55}, 80), true));
}

TEST(SamplesNeeded, demand_that_is_missed_counts_too) {
  select::MotorEvaluation motor = sampled(0.0, {0.0, 0.01}, 500);
  motor.short_probability = 0.05;
  motor.short_interval = select::Interval95{0.03, 0.07};
  EXPECT_TRUE(select::samples_needed(motor, false));
}

// Every verdict that more samples could change is shown as undecided, also that of a motor without enough current.
TEST(ShownVerdict, is_undecided_until_more_samples_would_not_change_it) {
  select::MotorEvaluation motor = sampled(0.9, {0.8, 0.99}, 600);
  EXPECT_EQ(shown_verdict(motor), ShownVerdict::pass);
  motor.samples_needed = 4352;
  EXPECT_EQ(shown_verdict(motor), ShownVerdict::undecided);
  motor.verdict = select::Verdict::infeasible;
  EXPECT_EQ(shown_verdict(motor), ShownVerdict::undecided);
  motor.samples_needed = {};
  EXPECT_EQ(shown_verdict(motor), ShownVerdict::infeasible);
}

// The nominal motor alone gives no verdict, so no word of a verdict describes it.
TEST(ShownVerdict, has_other_words_without_samples) {
  std::set<std::string_view> verdicts;
  std::set<std::string_view> nominal;
  for (const auto verdict : {select::Verdict::pass, select::Verdict::fail, select::Verdict::infeasible}) {
    for (const int samples : {0, 600}) {
      select::MotorEvaluation motor = sampled(0.0, {0.0, 0.01}, samples);
      motor.verdict = verdict;
      (samples > 0 ? verdicts : nominal).insert(to_string(shown_verdict(motor)));
    }
  }
  EXPECT_EQ(nominal.size(), 3U);
  for (const std::string_view word : nominal) {
    EXPECT_FALSE(verdicts.contains(word)) << word;
  }
}

TEST(OpenShare, is_the_share_whose_interval_covers_a_threshold) {
  select::MotorEvaluation motor = sampled(0.9, {0.88, 1.0}, 600);
  motor.games = 75;
  motor.verdict = select::Verdict::infeasible;
  motor.short_probability = 0.55;
  motor.short_interval = select::Interval95{0.42, 0.68};
  EXPECT_FALSE(open_share(motor)) << "decided";
  motor.samples_needed = 4352;
  ASSERT_TRUE(open_share(motor));
  EXPECT_TRUE(open_share(motor)->is_of_demand);
  EXPECT_EQ(open_share(motor)->threshold_ratio, select::kMajority);
  select::MotorEvaluation warm = sampled(0.03, {0.01, 0.11}, 600);
  warm.games = 75;
  warm.samples_needed = 1200;
  ASSERT_TRUE(open_share(warm));
  EXPECT_FALSE(open_share(warm)->is_of_demand);
  EXPECT_EQ(open_share(warm)->threshold_ratio, select::kMarginalProbability);
  EXPECT_EQ(words_of(*open_share(warm), 600), "18 of 600 samples exceed a limit (share 1…11 %; the verdict changes at 5 %)");
}

TEST(PassingText, agrees_in_number) {
  EXPECT_EQ(passing_text(1, 1, "motor"), "1 of 1 motor passes");
  EXPECT_EQ(passing_text(0, 1, "motor"), "0 of 1 motor passes");
  EXPECT_EQ(passing_text(1, 2, "motor"), "1 of 2 motors passes");
  EXPECT_EQ(passing_text(0, 2, "motor"), "0 of 2 motors pass");
}

}  // namespace
}  // namespace heatsoak::present
