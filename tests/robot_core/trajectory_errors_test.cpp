#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "robot_core/trajectory.h"
#include "trajectory_expectations.h"
#include "trajectory_reference.h"

namespace robot_core::reference {
namespace {

TEST(TrajectoryErrors, AreCodes) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const Task good{{0, 0.5, 0.1}, {1, 0.5, -0.1}, {2, -2, 2, -2, 6}};
  const auto result = [](const Task& task) {
    Motion motion;
    const PlanResult position = plan_position(task.start, task.target, task.limits, motion);
    Motion motions[2];
    const State start[2] = {{}, task.start};
    const State target[2] = {{}, task.target};
    const Limits limits[2] = {Limits::symmetric(1, 1, 1), task.limits};
    int failed_axis = -1;
    EXPECT_EQ(plan_synchronised(2, start, target, limits, motions, Target::at_position, &failed_axis), position);
    EXPECT_EQ(failed_axis, position == PlanResult::ok ? -1 : 1);
    return position;
  };
  EXPECT_EQ(result(good), PlanResult::ok);
  double Limits::*const fields[] = {&Limits::velocity_max, &Limits::velocity_min, &Limits::acceleration_max, &Limits::acceleration_min,
                                    &Limits::jerk_max};
  for (double Limits::*const field : fields) {
    Task task = good;
    task.limits.*field = 0.0;
    EXPECT_EQ(result(task), PlanResult::limit_without_room);
    task.limits.*field = -(good.limits.*field);
    EXPECT_EQ(result(task), PlanResult::limit_without_room);
    for (const double value : {nan, infinity, -infinity}) {
      task.limits.*field = value;
      EXPECT_EQ(result(task), PlanResult::not_finite);
    }
  }
  double State::*const values[] = {&State::position, &State::velocity, &State::acceleration};
  for (double State::*const value : values) {
    for (const double bad : {nan, infinity, -infinity}) {
      Task task = good;
      task.start.*value = bad;
      EXPECT_EQ(result(task), PlanResult::not_finite);
      task = good;
      task.target.*value = bad;
      EXPECT_EQ(result(task), PlanResult::not_finite);
    }
  }
  Task task = good;
  task.target.velocity = 2.001;
  EXPECT_EQ(result(task), PlanResult::target_velocity_beyond_limit);
  task = good;
  task.target.acceleration = -2.001;
  EXPECT_EQ(result(task), PlanResult::target_acceleration_beyond_limit);
  task.target = {1, -1.9, 1.9};  // with this acceleration at this velocity the velocity was below -2 before
  EXPECT_EQ(result(task), PlanResult::target_without_approach);
  task = good;
  task.target = {1, 2.0, 0};
  Motion motion;
  EXPECT_EQ(plan_position(task.start, task.target, task.limits, motion), PlanResult::ok);
  EXPECT_EQ(plan_position(task.start, task.target, task.limits, motion, Target::moving_on), PlanResult::target_velocity_beyond_limit);
  task = good;
  task.target.position = 1e308;
  task.limits.jerk_max = 1e-300;
  EXPECT_NE(result(task), PlanResult::ok);
}

TEST(TrajectoryErrors, ANumberOfAxesThatThePlannerDoesNotTake) {
  constexpr int kMany = kMostAxes + 2;
  State start[kMany];
  State target[kMany];
  Limits limits[kMany];
  Motion motions[kMany];
  for (int axis = 0; axis < kMany; ++axis) {
    target[axis] = {1, 0, 0};
    limits[axis] = Limits::symmetric(1, 1, 1);
  }
  for (const int count : {-1, 0, kMostAxes + 1, kMany}) {
    EXPECT_EQ(plan_synchronised(count, start, target, limits, motions), PlanResult::not_that_many_axes) << count;
    EXPECT_EQ(plan_velocity_synchronised(count, start, target, limits, motions), PlanResult::not_that_many_axes) << count;
  }
  EXPECT_EQ(plan_synchronised(kMostAxes, start, target, limits, motions), PlanResult::ok);
  EXPECT_EQ(plan_velocity_synchronised(kMostAxes, start, target, limits, motions), PlanResult::ok);
}

TEST(TrajectoryErrors, DistancesThatOverflow) {
  Motion motion;
  const Limits wide{1.7e308, -7.8, 8.3, -6.3, 29.9};
  EXPECT_EQ(plan_position({1.7e308, 0.97, 2.2e-308}, {-1.7e308, -3.6, -1.07}, wide, motion), PlanResult::out_of_range);
  EXPECT_EQ(motion.segment_count, 0);
  EXPECT_EQ(plan_bang_bang({1.7e308, 1, 0}, {-1.7e308, -1.8, 0}, {2.2e-308, -1.7e308, 1e-310, -5.8, 11}, motion), PlanResult::out_of_range);
  // Very high limits must not make a short path count as out of range.
  EXPECT_EQ(plan_position({0, 1, 0}, {1, 0, 0}, Limits::symmetric(1e200, 1e3, 1e4), motion), PlanResult::ok);
}

TEST(TrajectoryErrors, OfThePlaneAreCodes) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const State still[3] = {};
  const Limits yaw = Limits::symmetric(6, 20, 100);
  const auto result = [&](const State& x, const State& y, const PlaneLimits<double>& plane) {
    Motion motions[3];
    const State target[3] = {x, y, {}};
    return plan_plane(still, target, plane, yaw, motions);
  };
  EXPECT_EQ(result({1, 0, 0}, {1, 0, 0}, {2, 2, 6}), PlanResult::ok);
  EXPECT_EQ(result({1, 0, 0}, {1, 0, 0}, {2, 0, 6}), PlanResult::limit_without_room);
  EXPECT_EQ(result({1, 0, 0}, {1, 0, 0}, {2, 2, nan}), PlanResult::not_finite);
  EXPECT_EQ(result({1, nan, 0}, {1, 0, 0}, {2, 2, 6}), PlanResult::not_finite);
  // Each target is inside the square of the limits, but not inside the circle.
  EXPECT_EQ(result({1, 1.5, 0}, {1, 1.5, 0}, {2, 2, 6}), PlanResult::target_velocity_beyond_limit);
  EXPECT_EQ(result({1, 0, 1.5}, {1, 0, 1.5}, {2, 2, 6}), PlanResult::target_acceleration_beyond_limit);
  // Velocity along x and acceleration along y, both close to the limit, leave no split.
  EXPECT_EQ(result({1, 1.9, 0}, {1, 0, 1.9}, {2, 2, 6}), PlanResult::target_acceleration_beyond_limit);
  Motion motions[3];
  const State fast_x[3] = {{0, 0, 2.1}, {}, {}};
  EXPECT_EQ(plan_plane_velocity(still, fast_x, {2, 2, 6}, yaw, motions), PlanResult::target_acceleration_beyond_limit);
  const State fast_yaw[3] = {{}, {}, {0, 0, 21}};
  EXPECT_EQ(plan_plane_velocity(still, fast_yaw, {2, 2, 6}, yaw, motions), PlanResult::target_acceleration_beyond_limit);
  const State running_yaw[3] = {{}, {}, {0, 7, 0}};
  EXPECT_EQ(plan_plane_bang_bang(still, running_yaw, {2, 2, 6}, yaw, motions), PlanResult::target_velocity_beyond_limit);
}

TEST(TrajectoryErrors, WildNumbersNeverHang) {
  std::mt19937_64 random(16);
  const double wild[] = {0.0,
                         -0.0,
                         1e-320,
                         1e-300,
                         1e-150,
                         1e-12,
                         1.0,
                         -1.0,
                         1e12,
                         1e150,
                         1e300,
                         std::numeric_limits<double>::max(),
                         std::numeric_limits<double>::infinity(),
                         std::numeric_limits<double>::quiet_NaN()};
  const auto any = [&] { return (random() % 2 == 0 ? -1 : 1) * wild[random() % std::size(wild)]; };
  for (int i = 0; i < problem_count(); ++i) {
    const State start[3] = {{any(), any(), any()}, {any(), any(), any()}, {any(), any(), any()}};
    const State target[3] = {{any(), any(), any()}, {any(), any(), any()}, {any(), any(), any()}};
    Limits limits[3];
    for (Limits& l : limits) {
      l = {std::abs(any()), -std::abs(any()), std::abs(any()), -std::abs(any()), std::abs(any())};
    }
    Motion motions[3];
    const PlanResult result = plan_position(start[0], target[0], limits[0], motions[0]);
    if (result == PlanResult::ok) {
      EXPECT_TRUE(std::isfinite(motions[0].duration_s));
      EXPECT_LE(motions[0].segment_count, Motion::kMostSegments);
    }
    plan_velocity(start[0], target[0], limits[0], motions[0]);
    plan_bang_bang(start[0], target[0], limits[0], motions[0]);
    plan_synchronised(3, start, target, limits, motions);
    plan_velocity_synchronised(3, start, target, limits, motions);
    const PlaneLimits<double> plane{any(), any(), any()};
    plan_plane(start, target, plane, limits[2], motions);
    plan_plane_velocity(start, target, plane, limits[2], motions);
    plan_plane_bang_bang(start, target, plane, limits[2], motions);
  }
}

}  // namespace
}  // namespace robot_core::reference
