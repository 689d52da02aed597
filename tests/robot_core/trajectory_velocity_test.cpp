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

TEST(TrajectoryVelocity, IsABangBangMotionOfTheVelocity) {
  std::mt19937_64 random(10);
  for (int i = 0; i < problem_count(); ++i) {
    const Task task = i % 2 == 0 ? random_task(random) : violating_task(random);
    Motion motion;
    ASSERT_EQ(plan_velocity(task.start, task.target, task.limits, motion), PlanResult::ok);
    Task reached = task;
    reached.target.position = motion.target.position;
    expect_flawless(motion, reached, std::numeric_limits<double>::infinity());
    Motion other;
    const Limits one_lower{task.limits.acceleration_max, task.limits.acceleration_min, task.limits.jerk_max, -task.limits.jerk_max, 1};
    ASSERT_EQ(plan_bang_bang({task.start.velocity, task.start.acceleration, 0}, {task.target.velocity, task.target.acceleration, 0},
                             one_lower, other),
              PlanResult::ok);
    EXPECT_NEAR(motion.duration_s, other.duration_s, 1e-9 * (1 + other.duration_s)) << text(task);
  }
}

void expect_acceleration_kept(const Motion& motion, const Task& task, double most) {
  // The acceleration is linear between segment ends. A start outside its limits is on its way back.
  const double highest = std::max(task.limits.acceleration_max, task.start.acceleration);
  const double lowest = std::min(task.limits.acceleration_min, task.start.acceleration);
  for (int i = 0; i < motion.segment_count; ++i) {
    const State end = Motion::advanced(motion.segments[i].start, motion.segments[i].jerk, motion.segments[i].duration_s);
    EXPECT_LE(end.acceleration, highest + most * std::abs(highest)) << text(task);
    EXPECT_GE(end.acceleration, lowest - most * std::abs(lowest)) << text(task);
  }
}

TEST(TrajectoryVelocitySynchronised, ArriveTogetherWithinLimits) {
  std::mt19937_64 random(21);
  for (int i = 0; i < problem_count(); ++i) {
    std::vector<Task> tasks;
    for (int axis = 0; axis < 3; ++axis) {
      tasks.push_back(i % 4 == 3 ? violating_task(random) : i % 4 == 2 ? extreme_task(random) : random_task(random));
    }
    const Fleet fleet = velocity_synchronised(tasks);
    double slowest_s = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      const Motion& motion = fleet.motions[axis];
      Motion alone;
      ASSERT_EQ(plan_velocity(tasks[axis].start, tasks[axis].target, tasks[axis].limits, alone), PlanResult::ok);
      slowest_s = std::max(slowest_s, alone.duration_s);
      Task reached = tasks[axis];
      reached.target.position = motion.target.position;
      // Among the extreme tasks one axis may wait a million times its own duration for another.
      const double most = i % 4 == 2 ? 1e-8 : 1e-10;
      expect_flawless(motion, reached, std::numeric_limits<double>::infinity(), most);
      expect_acceleration_kept(motion, tasks[axis], most);
      EXPECT_EQ(motion.duration_s, fleet.motions[0].duration_s);
    }
    EXPECT_GE(fleet.motions[0].duration_s, slowest_s);
    if (HasFailure()) {
      ADD_FAILURE() << text(tasks[0]) << text(tasks[1]) << text(tasks[2]);
      break;
    }
  }
}

/// Upper bound of the velocity gain in that time: sum of the acceleration bound from both ends.
double most_gained(const Task& task, double duration_s) {
  constexpr int kSteps = 4000;
  const Limits& l = task.limits;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double time_s = duration_s * (i + 0.5) / kSteps;
    sum += std::min(
        {task.start.acceleration + l.jerk_max * time_s, task.target.acceleration + l.jerk_max * (duration_s - time_s), l.acceleration_max});
  }
  return sum * duration_s / kSteps;
}

bool is_velocity_possible(const Task& task, double duration_s, double room) {
  const double change = task.target.velocity - task.start.velocity;
  const double ramp_s = std::abs(task.target.acceleration - task.start.acceleration) / task.limits.jerk_max;
  return duration_s >= ramp_s * (1 - 1e-12) && change <= most_gained(task, duration_s) + room &&
         -change <= most_gained(mirrored(task), duration_s) + room;
}

TEST(TrajectoryVelocitySynchronised, NoEarlierTimeSuitsAll) {
  std::mt19937_64 random(22);
  int delayed = 0;
  for (int i = 0; i < problem_count() / 100; ++i) {
    const std::vector<Task> tasks{random_task(random), random_task(random), random_task(random)};
    const double together_s = velocity_synchronised(tasks).motions[0].duration_s;
    double slowest_s = 0.0;
    for (const Task& task : tasks) {
      Motion alone;
      ASSERT_EQ(plan_velocity(task.start, task.target, task.limits, alone), PlanResult::ok);
      slowest_s = std::max(slowest_s, alone.duration_s);
      EXPECT_TRUE(is_velocity_possible(task, together_s, 1e-4)) << text(task);
    }
    delayed += together_s > slowest_s * (1 + 1e-9) ? 1 : 0;
    // Rounding of the sums is far below the margin used here.
    for (double share = 0.005; share < 0.999; share += 0.005) {
      bool all = true;
      for (const Task& task : tasks) {
        all = all && is_velocity_possible(task, share * together_s, -1e-4);
      }
      EXPECT_FALSE(all) << share << " of " << together_s << text(tasks[0]) << text(tasks[1]) << text(tasks[2]);
    }
  }
  EXPECT_GT(delayed, 0);  // at least one axis cannot arrive at that time
}

TEST(TrajectoryVelocitySynchronised, EqualAxesGoStraightFromOneVelocityToTheOther) {
  const Limits limits = Limits::symmetric(3, 2, 6);
  const Fleet fleet = velocity_synchronised({{{0, 2, 0}, {0, 0.5, 0}, limits}, {{0, -1, 0}, {0, -0.25, 0}, limits}, {{}, {}, limits}});
  EXPECT_NEAR(fleet.motions[0].duration_s, 1.5 / 2 + 2.0 / 6, 1e-14);
  for (double share = 0.0; share <= 1.0; share += 0.01) {
    const double time_s = share * fleet.motions[0].duration_s;
    EXPECT_NEAR(fleet.motions[1].at(time_s).velocity, -fleet.motions[0].at(time_s).velocity / 2, 1e-14);
    EXPECT_EQ(fleet.motions[2].at(time_s).velocity, 0.0);
  }
}

TEST(TrajectoryVelocitySynchronised, ErrorsNameTheAxis) {
  const Limits limits = Limits::symmetric(3, 2, 6);
  const State start[2] = {{0, 1, 0}, {0, 1, 0}};
  const State target[2] = {{0, 0, 0}, {0, 0, 2.1}};
  const Limits both[2] = {limits, limits};
  Motion motions[2];
  int failed_axis = -1;
  EXPECT_EQ(plan_velocity_synchronised(2, start, target, both, motions, &failed_axis), PlanResult::target_acceleration_beyond_limit);
  EXPECT_EQ(failed_axis, 1);
  const Limits without_jerk[2] = {Limits::symmetric(3, 2, 0), limits};
  EXPECT_EQ(plan_velocity_synchronised(2, start, start, without_jerk, motions, &failed_axis), PlanResult::limit_without_room);
  EXPECT_EQ(failed_axis, 0);
}

}  // namespace
}  // namespace robot_core::reference
