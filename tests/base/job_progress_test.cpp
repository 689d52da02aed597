// Remaining time of jobs with uneven phases, on a clock that the test sets.
#include "base/job_progress.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "base/random.h"

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
        const double ratio = job.estimate().remaining->p50_s / left_s;
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

constexpr double kExact_spread = 1e-3;

/// Returns the estimate in a phase of 10 s, of which half is done, with later phases after it. All speeds are measured.
JobEstimate in_middle(std::vector<JobPhase> later) {
  double time_s = 0.0;
  const JobProgress job([&time_s] { return time_s; });
  later.insert(later.begin(), {"play", 10.0, 1.0, {}, kExact_spread});
  job.expect(std::move(later));
  const Progress progress = job.begin("play");
  time_s = 5.0;
  progress(1, 2);
  return job.estimate();
}

JobPhase exact(double work_s, double probability) { return {"play", work_s, probability, {}, kExact_spread}; }

// 5 or 15 s remain: both ends are stated unless one of them is improbable. The tolerance is for the speed, of which 5 s were measured.
TEST(JobProgress, a_phase_that_may_be_left_out_makes_a_range) {
  for (const auto& [probability, shortest_s, longest_s] :
       {std::tuple(0.02, 5.0, 5.0), std::tuple(0.3, 5.0, 15.0), std::tuple(0.7, 5.0, 15.0), std::tuple(0.98, 15.0, 15.0)}) {
    const JobEstimate estimate = in_middle({exact(10.0, probability)});
    EXPECT_NEAR(estimate.remaining->p025_s / shortest_s, 1.0, 0.2) << probability;
    EXPECT_NEAR(estimate.remaining->p975_s / longest_s, 1.0, 0.2) << probability;
    EXPECT_FALSE(estimate.is_open);
  }
}

// 5, 15 or 55 s remain. The likely time is the median.
TEST(JobProgress, the_likely_time_is_the_median) {
  for (const auto& [first, second, likely_s] : {std::tuple(0.2, 0.1, 5.0), std::tuple(0.9, 0.1, 15.0), std::tuple(0.9, 0.8, 55.0)}) {
    EXPECT_NEAR(in_middle({exact(10.0, first), exact(40.0, second)}).remaining->p50_s / likely_s, 1.0, 0.1) << first << ' ' << second;
  }
}

/// Returns the standard deviation of the logarithm of the remaining time that a range states.
double stated_sd(const JobEstimate& estimate) {
  constexpr double kQuantile_sd = 1.96;
  return std::log(estimate.remaining->p975_s / estimate.remaining->p025_s) / (2.0 * kQuantile_sd);
}

TEST(JobProgress, the_spread_of_a_phase_widens_the_range) {
  // 20 of 25 s scatter. The tolerance is for the speed, of which 5 s were measured.
  for (const double spread : {0.4, 0.8}) {
    const double relative_sd = 20.0 / 25.0 * std::sqrt(std::expm1(spread * spread));
    EXPECT_NEAR(stated_sd(in_middle({{"play", 20.0, 1.0, {}, spread}})), std::sqrt(std::log1p(relative_sd * relative_sd)), 0.04) << spread;
  }
}

TEST(JobProgress, independent_phases_average_their_spreads) {
  const std::vector<JobPhase> four(4, {"play", 25.0, 1.0, {}, 0.4});
  EXPECT_NEAR(stated_sd(in_middle(four)), 0.5 * stated_sd(in_middle({{"play", 100.0, 1.0, {}, 0.4}})), 0.03);
}

// Four phases with the same unmeasured speed are as uncertain as one.
TEST(JobProgress, phases_of_the_same_unknown_speed_deviate_together) {
  const std::vector<JobPhase> four(4, {"read", 25.0, 1.0, {}, kExact_spread});
  EXPECT_NEAR(stated_sd(in_middle(four)), stated_sd(in_middle({{"read", 100.0, 1.0, {}, kExact_spread}})), 0.02);
  const std::vector<JobPhase> different{
      {"a", 25.0, 1.0, {}, kExact_spread}, {"b", 25.0, 1.0, {}, kExact_spread}, {"c", 25.0, 1.0, {}, kExact_spread}};
  EXPECT_LT(stated_sd(in_middle(different)), 0.85 * stated_sd(in_middle(four)));
}

// Before anything has been measured, a computer may be three times slower or faster than the usual one.
TEST(JobProgress, the_first_range_covers_other_computers) {
  double time_s = 0.0;
  const JobProgress job([&time_s] { return time_s; });
  job.expect({{"play", 30.0}});
  const Progress progress = job.begin("play");
  time_s = 1.0;
  EXPECT_LT(job.estimate().remaining->p025_s, 10.0);
  EXPECT_GT(job.estimate().remaining->p975_s, 90.0);
  time_s = 10.0;
  progress(1, 9);
  EXPECT_GT(job.estimate().remaining->p025_s, 40.0) << "80 s are left once a ninth took 10 s";
  EXPECT_LT(job.estimate().remaining->p975_s, 160.0);
}

/// A job of random phases, as declared, and of their actual durations; empty if a phase is left out.
struct RandomJob {
  std::vector<JobPhase> declared;
  std::vector<std::optional<double>> actual_s;
};
RandomJob random_job(Random& random) {
  // Box and Muller's transformation.
  const auto log_normal = [&random](double sd) {
    return std::exp(sd * std::sqrt(-2.0 * std::log(random.uniform())) * std::cos(2.0 * std::numbers::pi * random.uniform()));
  };
  const double computer = log_normal(0.5);
  RandomJob job;
  double probability = 1.0;
  bool is_left_out = false;
  for (const char* const what : {"read", "fit", "fit", "test", "fit", "test"}) {
    const double spread = 0.1 + 0.5 * random.uniform();
    probability *= job.declared.size() < 2 ? 1.0 : 0.5 + 0.5 * random.uniform();
    job.declared.push_back({what, 3.0 * log_normal(1.0), probability, {}, spread});
    const double before = job.declared.size() < 2 ? 1.0 : job.declared[job.declared.size() - 2].probability;
    is_left_out = is_left_out || random.uniform() > probability / before;
    job.actual_s.push_back(is_left_out ? std::nullopt : std::optional(job.declared.back().work_s * computer * log_normal(spread)));
  }
  return job;
}

// Jobs whose phases scatter as they declare: 19 of 20 ranges contain the true remaining time.
TEST(JobProgress, ranges_contain_the_remaining_time) {
  constexpr int kJobs = 150;
  constexpr int kLooks = 20;
  Random random(7, 0);
  double within = 0.0;
  double looks = 0.0;
  for (int i = 0; i < kJobs; ++i) {
    const RandomJob played = random_job(random);
    double time_s = 0.0;
    double all_s = 0.0;
    for (const std::optional<double>& each : played.actual_s) {
      all_s += each.value_or(0.0);
    }
    const JobProgress job([&time_s] { return time_s; });
    job.expect(played.declared);
    double begin_s = 0.0;
    for (std::size_t p = 0; p < played.declared.size() && played.actual_s[p]; ++p) {
      const Progress progress = job.begin(played.declared[p].what);
      for (int look = 1; look < kLooks; ++look) {
        time_s = begin_s + *played.actual_s[p] * look / kLooks;
        progress(static_cast<std::size_t>(look), kLooks);
        const JobEstimate estimate = job.estimate();
        looks += 1.0;
        within += all_s - time_s >= estimate.remaining->p025_s && all_s - time_s <= estimate.remaining->p975_s ? 1.0 : 0.0;
      }
      begin_s += *played.actual_s[p];
    }
  }
  EXPECT_GE(within / looks, 0.93);
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
  EXPECT_NEAR(job.estimate().remaining->p50_s, 100.0, 15.0);
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
  EXPECT_GT(job.estimate().remaining->p50_s, 50.0);
  job.begin("b");
  EXPECT_NEAR(job.estimate().remaining->p50_s, 1.0, 0.1);
}

TEST(JobProgress, says_that_more_may_follow) {
  double time_s = 0.0;
  const JobProgress job([&time_s] { return time_s; });
  job.expect({{"a", 2.0}}, true);
  job.begin("a");
  EXPECT_TRUE(job.estimate().is_open);
  job.expect({{"b", 2.0}});
  EXPECT_FALSE(job.estimate().is_open);
  EXPECT_NEAR(job.estimate().remaining->p50_s, 4.0, 1e-6);
}

TEST(JobProgress, a_repeated_phase_takes_as_long_as_before) {
  double time_s = 0.0;
  const JobProgress job([&time_s] { return time_s; });
  job.expect({{"search", 10.0}, {"write", 1.0}}, true);
  job.begin("search");
  time_s = 20.0;
  job.begin("search");
  EXPECT_NEAR(job.estimate().remaining->p50_s, 22.0, 0.5);
}

TEST(JobProgress, nobody_who_watches_costs_nothing) {
  const JobProgress job;
  job.expect({{"a", 1.0}});
  EXPECT_FALSE(job.begin("a"));
  EXPECT_FALSE(job.estimate().remaining);
}

}  // namespace
}  // namespace heatsoak::base
