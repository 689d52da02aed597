// Wording of the remaining time: one time only if it is known within a factor of two.
#include "present/progress_words.h"

#include <gtest/gtest.h>

#include <string>

namespace heatsoak::present {
namespace {

/// Returns the words for the quantiles of 2.5, 50 and 97.5 %.
std::string words_of(double low_s, double median_s, double high_s, bool is_open = false) {
  double most_share = 0.0;
  return progress_words({.what = "fitting",
                         .elapsed_s = 10.0,
                         .done_share = 0.25,
                         .remaining = base::RemainingTime{low_s, median_s, high_s},
                         .is_open = is_open},
                        most_share);
}

TEST(ProgressWords, one_time_if_it_is_known_within_a_factor_of_two) {
  EXPECT_EQ(words_of(20.0, 30.0, 45.0), "fitting: 25 %, 30 s left");
  EXPECT_EQ(words_of(100.0, 130.0, 160.0), "fitting: 25 %, 2 min left") << "rounded to the nearest minute";
}

// The median may be nearer to one end than a factor of two to the other.
TEST(ProgressWords, the_time_is_within_a_factor_of_two_of_both_ends) {
  EXPECT_EQ(words_of(10.0, 12.0, 38.0), "fitting: 25 %, 19 s left");
  EXPECT_EQ(words_of(10.0, 36.0, 38.0), "fitting: 25 %, 20 s left");
}

TEST(ProgressWords, else_a_range_without_a_share) {
  EXPECT_EQ(words_of(11.0, 20.0, 45.0), "fitting: 11 to 45 s left");
  EXPECT_EQ(words_of(23.0, 50.0, 150.0), "fitting: 23 s to 3 min left");
  EXPECT_EQ(words_of(150.0, 500.0, 900.5), "fitting: 2 to 16 min left");
  EXPECT_EQ(words_of(0.1, 3.0, 8.2), "fitting: 1 to 9 s left");
}

TEST(ProgressWords, the_least_time_if_the_end_is_open) { EXPECT_EQ(words_of(14.1, 20.0, 90.0, true), "fitting: at least 14 s left"); }

TEST(ProgressWords, the_last_seconds_need_no_distinction) {
  EXPECT_EQ(words_of(0.01, 0.1, 0.9), "fitting: 25 %, less than 5 s left");
  EXPECT_EQ(words_of(0.1, 3.0, 4.5), "fitting: 25 %, less than 5 s left");
  EXPECT_EQ(words_of(4.0, 4.5, 5.2), "fitting: 25 %, 5 s left");
}

TEST(ProgressWords, the_share_does_not_fall) {
  const base::RemainingTime known{30.0, 30.0, 30.0};
  double most_share = 0.5;
  EXPECT_EQ(progress_words({.what = "a", .done_share = 0.2, .remaining = known}, most_share), "a: 50 %, 30 s left");
  progress_words({.what = "a", .done_share = 1.0, .remaining = known}, most_share);
  EXPECT_DOUBLE_EQ(most_share, 0.99) << "the job is not over";
}

}  // namespace
}  // namespace heatsoak::present
