#include "robot_core/trajectory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "trajectory_expectations.h"
#include "trajectory_reference.h"

namespace robot_core::reference {
namespace {

Task rest_to_rest(double distance, double velocity, double acceleration, double jerk) {
  return {{}, {distance, 0, 0}, Limits::symmetric(velocity, acceleration, jerk)};
}

TEST(TrajectoryClosedForm, RestToRest) {
  EXPECT_NEAR(duration_s(rest_to_rest(1, 100, 100, 6)), 4 * std::cbrt(1.0 / 12), 1e-14);                    // jerk limit alone
  EXPECT_NEAR(duration_s(rest_to_rest(8, 100, 2, 6)), 2.0 / 6 + std::sqrt(4.0 / 36 + 4 * 8.0 / 2), 1e-14);  // holds the acceleration
  EXPECT_NEAR(duration_s(rest_to_rest(8, 2, 2, 6)), 8.0 / 2 + 2.0 / 2 + 2.0 / 6, 1e-14);                    // also cruises
  EXPECT_NEAR(duration_s(rest_to_rest(8, 0.5, 2, 6)), 8.0 / 0.5 + 2 * std::sqrt(0.5 / 6), 1e-14);           // cruises without holds
  EXPECT_NEAR(duration_s(rest_to_rest(-8, 2, 2, 6)), 8.0 / 2 + 2.0 / 2 + 2.0 / 6, 1e-14);
}

TEST(TrajectoryClosedForm, NothingToDo) {
  for (const State& state : {State{}, State{3, 0, 0}, State{1, 2, 0}, State{1, -2, 0}, State{1, 0.5, 1.5}, State{1, 0.5, -1.5}}) {
    const Task task{state, state, Limits::symmetric(3, 2, 6)};
    const Motion motion = planned(task);
    EXPECT_EQ(motion.duration_s, 0.0) << text(task);
    EXPECT_EQ(motion.at(0).position, state.position);
    EXPECT_NEAR(motion.at(2).position, state.position + 2 * state.velocity + 2 * state.acceleration, 1e-14);
  }
}

TEST(TrajectoryClosedForm, OneSegment) {
  // The ends lie on one parabola of full jerk: no other motion arrives as early.
  for (const double a0 : {-1.2, -0.3, 0.0, 0.4, 1.2}) {
    for (const double jerk : {6.0, -6.0}) {
      const State start{0.3, 0.4, a0};
      const State target = Motion::advanced(start, jerk, 0.1);
      EXPECT_NEAR(duration_s({start, target, Limits::symmetric(3, 2, 6)}), 0.1, 1e-12);
    }
  }
}

TEST(TrajectoryClosedForm, AlmostNothingToDo) {
  // The distance is 1e-11 of the one that braking the acceleration would take, but it is no rounding error.
  const Task task{{-4.3586650273293863e-07, 0, -2.2764570448183719},
                  {0, 0, -2.2764570448183719},
                  Limits::symmetric(96.018266215174421, 10.86836188129778, 0.026985785523818421)};
  const Motion motion = planned(task);
  EXPECT_GT(motion.duration_s, 1.0);
  expect_flawless(motion, task);
}

TEST(Trajectory, EvaluatesBeforeAndAfter) {
  const Task task{{1, 0.5, 0.2}, {3, 1, -0.5}, Limits::symmetric(2, 2, 6)};
  const Motion motion = planned(task);
  EXPECT_EQ(motion.at(-1).position, 1.0);
  EXPECT_EQ(motion.at(motion.duration_s).position, 3.0);
  const State later = motion.at(motion.duration_s + 0.5);
  EXPECT_NEAR(later.position, 3 + 0.5 - 0.0625, 1e-14);
  EXPECT_NEAR(later.velocity, 0.75, 1e-14);
  EXPECT_EQ(motion.jerk_at(-0.1), 0.0);
  EXPECT_EQ(std::abs(motion.jerk_at(0)), 6.0);
  EXPECT_EQ(motion.jerk_at(motion.duration_s), 0.0);
}

TEST(TrajectoryRandom, ArrivesWithinLimits) {
  std::mt19937_64 random(1);
  for (int i = 0; i < problem_count(); ++i) {
    const Task task = i % 2 == 0 ? random_task(random) : extreme_task(random);
    expect_flawless(planned(task), task);
    if (HasFailure()) {
      break;
    }
  }
}

TEST(TrajectoryRandom, BringsAViolatingStartBack) {
  std::mt19937_64 random(2);
  for (int i = 0; i < problem_count(); ++i) {
    const Task task = violating_task(random);
    const Motion motion = planned(task);
    const double infinity = std::numeric_limits<double>::infinity();
    expect_flawless(motion, task, infinity);
    // Motions from inside go no further out than the start forces them to; later all are inside.
    const Limits& l = task.limits;
    const State& s = task.start;
    const double inevitable = s.acceleration * std::abs(s.acceleration) / (2 * l.jerk_max);
    const double highest = std::max({l.velocity_max, s.velocity, s.velocity + inevitable}) + 1e-9;
    const double lowest = std::min({l.velocity_min, s.velocity, s.velocity + inevitable}) - 1e-9;
    for (double share = 0.0; share <= 1.0; share += 0.01) {
      const State at = motion.at(share * motion.duration_s);
      EXPECT_LE(at.velocity, highest) << text(task);
      EXPECT_GE(at.velocity, lowest) << text(task);
      EXPECT_LE(at.acceleration, std::max(l.acceleration_max, s.acceleration) + 1e-9) << text(task);
      EXPECT_GE(at.acceleration, std::min(l.acceleration_min, s.acceleration) - 1e-9) << text(task);
    }
    if (HasFailure()) {
      break;
    }
  }
}

TEST(TrajectoryOptimum, NoSwitchingStructureIsFaster) {
  std::mt19937_64 random(3);
  int missed = 0;
  int longer = 0;
  double largest_gap = 0.0;
  const int count = problem_count() / 2;
  for (int i = 0; i < count; ++i) {
    const Task task = i % 4 == 3 ? extreme_task(random) : random_task(random);
    const double planned_s = duration_s(task);
    const double searched_s = earliest_by_search(task, 300);
    if (searched_s > planned_s * (1 + 1e-6)) {
      ++missed;  // the search missed a motion that exists for less than one of its samples
    } else {
      largest_gap = std::max(largest_gap, std::abs(planned_s - searched_s) / std::max(searched_s, 1e-300));
    }
    if (planned_s > searched_s * (1 + 1e-8) + 1e-300) {
      ++longer;
      ADD_FAILURE() << text(task) << " takes " << planned_s << ", but " << searched_s << " is possible";
    }
    if (longer > 5) {
      break;
    }
  }
  EXPECT_LE(missed, count / 100);
  RecordProperty("largest_gap", std::to_string(largest_gap));
}

TEST(TrajectoryOptimum, ShorterIsImpossible) {
  // The bound assumes no structure or direction, so it shows that no other kind of motion is faster.
  std::mt19937_64 random(4);
  int undecided = 0;
  int asked = 0;
  for (int i = 0; i < problem_count() / 40; ++i) {
    const Task task = random_task(random);
    const double planned_s = duration_s(task);
    for (const double share : {0.3, 0.6, 0.8, 0.9, 0.95, 0.98, 0.99}) {
      ++asked;
      undecided += is_impossible(task, share * planned_s, 500) ? 0 : 1;
    }
    EXPECT_FALSE(is_impossible(task, planned_s * (1 + 1e-9), 500)) << text(task);
  }
  // A grid cannot decide a case in which nearly all of the time is a cruise.
  EXPECT_LE(undecided, asked / 500) << asked;
}

TEST(TrajectorySymmetry, MirrorReversalUnits) {
  std::mt19937_64 random(5);
  for (int i = 0; i < problem_count(); ++i) {
    const Task task = i % 2 == 0 ? random_task(random) : extreme_task(random);
    const double planned_s = duration_s(task);
    EXPECT_NEAR(duration_s(mirrored(task)), planned_s, 1e-12 * planned_s) << text(task);
    EXPECT_NEAR(duration_s(reversed(task)), planned_s, 1e-10 * planned_s) << text(task);
    EXPECT_NEAR(duration_s(scaled(task, 1024.0, 0.125)), 0.125 * planned_s, 1e-12 * planned_s) << text(task);
    if (HasFailure()) {
      break;
    }
  }
}

TEST(TrajectoryBangBang, ClosedForms) {
  Motion motion;
  const auto planned_s = [&motion](const State& start, const State& target, const Limits& limits) {
    EXPECT_EQ(plan_bang_bang(start, target, limits, motion), PlanResult::ok);
    return motion.duration_s;
  };
  const Limits limits = Limits::symmetric(2, 2, 0);
  EXPECT_NEAR(planned_s({}, {1, 0, 0}, limits), 2 * std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(planned_s({}, {10, 0, 0}, limits), 5 + 1, 1e-15);
  EXPECT_NEAR(planned_s({0, 1, 0}, {0.75, 2, 0}, limits), 0.5, 1e-15);
  EXPECT_EQ(planned_s({1, 1, 0}, {1, 1, 0}, limits), 0.0);
}

TEST(TrajectoryBangBang, IsTheLimitOfLargeJerk) {
  std::mt19937_64 random(11);
  for (int i = 0; i < problem_count() / 10; ++i) {
    Task task = random_task(random);
    task.start.acceleration = task.target.acceleration = 0.0;
    task.limits.jerk_max = 1e7;
    Motion motion;
    ASSERT_EQ(plan_bang_bang(task.start, task.target, task.limits, motion), PlanResult::ok);
    // Compare the end velocity and position of the last segment; its acceleration then drops to zero.
    const auto& last = motion.segments[motion.segment_count - 1];
    const State end = Motion::advanced(last.start, 0, last.duration_s);
    EXPECT_NEAR(end.position, task.target.position, 1e-9 * (1 + motion.duration_s));
    EXPECT_NEAR(end.velocity, task.target.velocity, 1e-9);
    EXPECT_NEAR(duration_s(task), motion.duration_s, 1e-2 * (1 + motion.duration_s)) << text(task);
    EXPECT_GE(duration_s(task), motion.duration_s * (1 - 1e-9)) << text(task);
  }
}

}  // namespace
}  // namespace robot_core::reference
