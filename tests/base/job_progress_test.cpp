// Remaining time of jobs with uneven phases, on a clock that the test sets.
#include "base/job_progress.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

namespace heatsoak::base {
namespace {

/// A phase as it is declared, and as it happens on this computer.
struct Played {
  std::string what;
  double expected_s;
  double actual_s;
  std::size_t steps;  ///< reports in equal intervals; 0: none until the end
};

/// Runs the phases on a simulated clock. Returns the largest ratio, in either direction, of the estimated to the true remaining time, from
/// `from_share` to `until_share` of the job, without its last second.
double worst_ratio(const std::vector<Played>& phases, double from_share, double until_share = 1.0) {
  double time_s = 0.0;
  const double all_s =
      std::accumulate(phases.begin(), phases.end(), 0.0, [](double sum_s, const Played& each) { return sum_s + each.actual_s; });
  const JobProgress job([&time_s] { return time_s; });
  std::vector<JobPhase> expected;
  for (const Played& each : phases) {
    expected.push_back({each.what, each.expected_s});
  }
  job.expect(expected);
  double worst = 1.0;
  double begin_s = 0.0;
  for (const Played& each : phases) {
    const Progress progress = job.begin(each.what);
    constexpr int kLooks = 200;
    for (int look = 1; look < kLooks; ++look) {
      const double share = static_cast<double>(look) / kLooks;
      time_s = begin_s + share * each.actual_s;
      const auto done = static_cast<std::size_t>(share * static_cast<double>(each.steps));
      const auto before = static_cast<std::size_t>((share - 1.0 / kLooks) * static_cast<double>(each.steps));
      if (done > before) {
        progress(done, each.steps);
      }
      const double left_s = all_s - time_s;
      if (time_s >= from_share * all_s && time_s <= until_share * all_s && left_s > 1.0) {
        const double ratio = *job.estimate().longest_s / left_s;
        worst = std::max({worst, ratio, 1.0 / ratio});
      }
    }
    begin_s += each.actual_s;
  }
  return worst;
}

// The second phase is the long one: an estimate from the first phase alone would be wrong by a factor of ten.
TEST(JobProgress, counts_the_phases_that_follow) {
  EXPECT_LT(worst_ratio({{"play", 10.0, 10.0, 75}, {"evaluate", 2.0, 2.0, 75}, {"change", 100.0, 100.0, 30}}, 0.0), 1.3);
}

TEST(JobProgress, is_right_within_a_factor_of_two_on_a_slower_computer_from_a_fifth_on) {
  EXPECT_LT(worst_ratio({{"play", 5.0, 20.0, 75}, {"evaluate", 1.0, 4.0, 75}, {"change", 10.0, 40.0, 30}}, 0.05), 2.0);
  EXPECT_LT(worst_ratio({{"play", 20.0, 5.0, 75}, {"evaluate", 4.0, 1.0, 75}, {"change", 40.0, 10.0, 30}}, 0.05), 2.0);
}

TEST(JobProgress, is_right_within_a_factor_of_two_where_declared_durations_are_off_by_half) {
  EXPECT_LT(worst_ratio({{"play", 10.0, 15.0, 75}, {"evaluate", 10.0, 6.0, 40}, {"change", 10.0, 13.0, 20}}, 0.2), 2.0);
}

/// Returns the estimate in a phase of 10 s, of which half is done, with possible phases after it.
JobEstimate in_middle(std::vector<JobPhase> later) {
  double time_s = 0.0;
  const JobProgress job([&time_s] { return time_s; });
  later.insert(later.begin(), {"play", 10.0});
  job.expect(std::move(later));
  const Progress progress = job.begin("play");
  time_s = 5.0;
  progress(1, 2);
  return job.estimate();
}

// 5 or 105 s remain: both ends are stated unless one of them is improbable.
TEST(JobProgress, a_phase_that_may_be_left_out_makes_a_range) {
  for (const auto& [probability, shortest_s, longest_s] :
       {std::tuple(0.05, 5.0, 5.0), std::tuple(0.3, 5.0, 105.0), std::tuple(0.7, 5.0, 105.0), std::tuple(0.95, 105.0, 105.0)}) {
    const JobEstimate estimate = in_middle({{"more", 100.0, probability}});
    EXPECT_NEAR(*estimate.shortest_s, shortest_s, 0.1) << probability;
    EXPECT_NEAR(*estimate.longest_s, longest_s, 0.1) << probability;
    EXPECT_FALSE(estimate.is_open);
  }
}

// 5, 25 or 185 s remain, with probabilities of 40, 55 and 5 %.
TEST(JobProgress, improbable_phases_do_not_widen_the_range) {
  const JobEstimate estimate = in_middle({{"play", 20.0, 0.6}, {"play", 160.0, 0.05}});
  EXPECT_NEAR(*estimate.shortest_s, 5.0, 0.1);
  EXPECT_NEAR(*estimate.longest_s, 25.0, 0.1);
}

// 5, 25 or 185 s remain. The likely time is the middle of those that are together most probable within a factor of two.
TEST(JobProgress, the_likely_time_is_most_often_within_a_factor_of_two) {
  for (const auto& [first, second, likely_s] : {std::tuple(0.2, 0.1, 5.0), std::tuple(0.9, 0.1, 25.0), std::tuple(0.9, 0.8, 185.0)}) {
    EXPECT_NEAR(*in_middle({{"play", 20.0, first}, {"play", 160.0, second}}).likely_s, likely_s, 0.3) << first << ' ' << second;
  }
  EXPECT_NEAR(*in_middle({{"play", 4.0, 0.5}}).likely_s, std::sqrt(5.0 * 9.0), 0.2) << "both are within a factor of two";
}

// The range contains the true remaining time at least as often as stated, when phases follow with their declared probabilities.
TEST(JobProgress, the_range_contains_four_fifths_of_the_remaining_times) {
  const std::vector<JobPhase> phases{
      {"more", 20.0, 0.8}, {"more", 40.0, 0.5}, {"more", 80.0, 0.35}, {"more", 160.0, 0.2}, {"more", 320.0, 0.15}};
  const JobEstimate estimate = in_middle(phases);
  double within = 0.0;
  double remaining_s = 5.0;
  for (std::size_t followed = 0; followed <= phases.size(); ++followed) {
    const double here =
        (followed > 0 ? phases[followed - 1].probability : 1.0) - (followed < phases.size() ? phases[followed].probability : 0.0);
    within += remaining_s >= *estimate.shortest_s - 0.1 && remaining_s <= *estimate.longest_s + 0.1 ? here : 0.0;
    remaining_s += followed < phases.size() ? phases[followed].work_s : 0.0;
  }
  EXPECT_GE(within, 0.8);
}

// A kind that was measured counts with its own speed, not with that of the job.
TEST(JobProgress, measures_each_kind_of_work) {
  EXPECT_LT(worst_ratio({{"play", 1.0, 1.0, 5}, {"evaluate", 1.0, 20.0, 5}, {"play", 10.0, 10.0, 50}, {"evaluate", 10.0, 200.0, 50}}, 0.12),
            1.3);
}

// A phase that has not begun counts with the speed of its kind: "test" is as slow as "fit", although most of the job was fast.
TEST(JobProgress, a_new_phase_has_the_speed_of_its_kind) {
  double time_s = 0.0;
  const JobProgress job([&time_s] { return time_s; });
  job.expect({{"read", 10.0}, {"fit", 1.0, 1.0, "slow"}, {"test", 10.0, 1.0, "slow"}, {"write", 1.0}});
  job.begin("read");
  time_s = 10.0;
  const Progress fit = job.begin("fit");
  time_s = 20.0;
  fit(1, 1);
  EXPECT_NEAR(*job.estimate().longest_s, 100.0, 15.0);
}

TEST(JobProgress, a_phase_without_reports_proceeds_as_expected) {
  EXPECT_LT(worst_ratio({{"read", 1.0, 1.0, 0}, {"fit", 9.0, 9.0, 0}, {"write", 10.0, 10.0, 0}}, 0.0), 2.0);
  EXPECT_LT(worst_ratio({{"read", 2.0, 2.0, 0}, {"fit", 10.0, 14.0, 0}, {"write", 10.0, 12.0, 0}}, 0.2, 0.9), 2.0);
}

TEST(JobProgress, a_skipped_phase_no_longer_counts) {
  double time_s = 0.0;
  const JobProgress job([&time_s] { return time_s; });
  job.expect({{"a", 1.0}, {"maybe", 100.0}, {"b", 1.0}});
  job.begin("a");
  time_s = 1.0;
  EXPECT_GT(*job.estimate().longest_s, 50.0);
  job.begin("b");
  EXPECT_NEAR(*job.estimate().longest_s, 1.0, 0.1);
}

TEST(JobProgress, says_that_more_may_follow) {
  double time_s = 0.0;
  const JobProgress job([&time_s] { return time_s; });
  job.expect({{"a", 2.0}}, true);
  job.begin("a");
  EXPECT_TRUE(job.estimate().is_open);
  job.expect({{"b", 2.0}});
  EXPECT_FALSE(job.estimate().is_open);
  EXPECT_NEAR(*job.estimate().longest_s, 4.0, 1e-9);
}

TEST(JobProgress, a_repeated_phase_takes_as_long_as_before) {
  double time_s = 0.0;
  const JobProgress job([&time_s] { return time_s; });
  job.expect({{"search", 10.0}, {"write", 1.0}}, true);
  job.begin("search");
  time_s = 20.0;
  job.begin("search");
  EXPECT_NEAR(*job.estimate().longest_s, 22.0, 0.5);
}

TEST(JobProgress, nobody_who_watches_costs_nothing) {
  const JobProgress job;
  job.expect({{"a", 1.0}});
  EXPECT_FALSE(job.begin("a"));
  EXPECT_FALSE(job.estimate().longest_s);
}

}  // namespace
}  // namespace heatsoak::base
