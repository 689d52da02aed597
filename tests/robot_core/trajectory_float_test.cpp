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

AxisState<float> narrowed(const State& s) {
  return {static_cast<float>(s.position), static_cast<float>(s.velocity), static_cast<float>(s.acceleration)};
}

AxisLimits<float> narrowed(const Limits& l) {
  return {static_cast<float>(l.velocity_max), static_cast<float>(l.velocity_min), static_cast<float>(l.acceleration_max),
          static_cast<float>(l.acceleration_min), static_cast<float>(l.jerk_max)};
}

TEST(TrajectoryFloat, KeepsSixDigits) {
  std::mt19937_64 random(17);
  double worst_end = 0.0;
  double worst_limit = 0.0;
  int different = 0;
  for (int i = 0; i < problem_count(); ++i) {
    Task task = random_task(random);
    const AxisState<float> start = narrowed(task.start);
    const AxisState<float> target = narrowed(task.target);
    const AxisLimits<float> limits = narrowed(task.limits);
    Trajectory<float> motion;
    const PlanResult result = plan_position(start, target, limits, motion);
    ASSERT_EQ(result, PlanResult::ok) << text(task);
    const TrajectorySegment<float>& last = motion.segments[motion.segment_count - 1];
    const AxisState<float> end = Trajectory<float>::advanced(last.start, last.jerk, last.duration_s);
    const State scale = scale_of(task, static_cast<double>(motion.duration_s));
    worst_end = std::max({worst_end, std::abs(static_cast<double>(end.position - target.position)) / scale.position,
                          std::abs(static_cast<double>(end.velocity - target.velocity)) / scale.velocity,
                          std::abs(static_cast<double>(end.acceleration - target.acceleration)) / scale.acceleration});
    for (int k = 0; k < motion.segment_count; ++k) {
      const AxisState<float>& s = motion.segments[k].start;
      worst_limit = std::max({worst_limit, static_cast<double>(s.velocity / limits.velocity_max) - 1,
                              static_cast<double>(s.velocity / limits.velocity_min) - 1,
                              static_cast<double>(s.acceleration / limits.acceleration_max) - 1,
                              static_cast<double>(s.acceleration / limits.acceleration_min) - 1});
    }
    // Rounding the ends may make the shortest path impossible; otherwise the durations agree.
    Motion exact;
    if (plan_position(widened(start), widened(target), task.limits, exact) != PlanResult::ok) {
      continue;  // rounding moves a target on the edge outside
    }
    different += std::abs(exact.duration_s - static_cast<double>(motion.duration_s)) > 1e-3 * exact.duration_s ? 1 : 0;
  }
  EXPECT_LE(worst_end, 1e-4);
  EXPECT_LE(worst_limit, 1e-4);
  RecordProperty("worst_end", std::to_string(worst_end));
  RecordProperty("worst_limit", std::to_string(worst_limit));
  RecordProperty("different", std::to_string(different));
  EXPECT_LE(different, problem_count() / 500);
}

/// Returns the state to which the last segment leads.
State end_of(const Trajectory<float>& motion) {
  const TrajectorySegment<float>& last = motion.segments[motion.segment_count - 1];
  return widened(Trajectory<float>::advanced(last.start, last.jerk, last.duration_s));
}

TEST(TrajectoryFloat, BringsAViolatingStartBackAsDoubleDoes) {
  std::mt19937_64 random(25);
  int different = 0;
  for (int i = 0; i < problem_count(); ++i) {
    const Task task = violating_task(random);
    const AxisState<float> start = narrowed(task.start);
    const AxisState<float> target = narrowed(task.target);
    const AxisLimits<float> limits = narrowed(task.limits);
    Trajectory<float> motion;
    ASSERT_EQ(plan_position(start, target, limits, motion), PlanResult::ok) << text(task);
    Motion exact;
    if (plan_position(widened(start), widened(target), widened(limits), exact) != PlanResult::ok) {
      continue;  // rounding moves a target on the edge outside
    }
    const Task rounded{widened(start), widened(target), widened(limits)};
    // Until its acceleration is zero, the start may go far beyond its velocity limits.
    const double excursion = rounded.start.acceleration * rounded.start.acceleration / (2 * rounded.limits.jerk_max);
    State scale = scale_of(rounded, exact.duration_s);
    scale.velocity += excursion;
    scale.position += excursion * exact.duration_s;
    const State end = end_of(motion);
    EXPECT_LE(std::abs(end.position - rounded.target.position), 1e-4 * scale.position) << text(task);
    EXPECT_LE(std::abs(end.velocity - rounded.target.velocity), 1e-4 * scale.velocity) << text(task);
    EXPECT_LE(std::abs(end.acceleration - rounded.target.acceleration), 1e-4 * scale.acceleration) << text(task);
    different += std::abs(exact.duration_s - static_cast<double>(motion.duration_s)) > 1e-3 * exact.duration_s ? 1 : 0;
    if (HasFailure()) {
      break;
    }
  }
  EXPECT_LE(different, problem_count() / 500);
}

TEST(TrajectoryFloat, VelocitiesTogether) {
  std::mt19937_64 random(26);
  int different = 0;
  for (int i = 0; i < problem_count(); ++i) {
    AxisState<float> start[3];
    AxisState<float> target[3];
    AxisLimits<float> limits[3];
    std::vector<Task> tasks;
    for (int axis = 0; axis < 3; ++axis) {
      const Task task = i % 2 == 0 ? random_task(random) : violating_task(random);
      start[axis] = narrowed(task.start);
      target[axis] = narrowed(task.target);
      limits[axis] = narrowed(task.limits);
      tasks.push_back({widened(start[axis]), widened(target[axis]), widened(limits[axis])});
    }
    Trajectory<float> motions[3];
    ASSERT_EQ(plan_velocity_synchronised(3, start, target, limits, motions), PlanResult::ok);
    const double exact_s = velocity_synchronised(tasks).motions[0].duration_s;
    different += std::abs(exact_s - static_cast<double>(motions[0].duration_s)) > 1e-4 * exact_s ? 1 : 0;
    for (int axis = 0; axis < 3; ++axis) {
      const State scale = scale_of(tasks[axis], exact_s);
      const State end = end_of(motions[axis]);
      EXPECT_LE(std::abs(end.velocity - tasks[axis].target.velocity), 1e-4 * (scale.velocity + scale.acceleration * exact_s));
      EXPECT_LE(std::abs(end.acceleration - tasks[axis].target.acceleration), 1e-4 * scale.acceleration);
    }
    if (HasFailure()) {
      ADD_FAILURE() << text(tasks[0]) << text(tasks[1]) << text(tasks[2]);
      break;
    }
  }
  EXPECT_LE(different, problem_count() / 500);
}

TEST(TrajectoryFloat, SynchronisedAndInThePlane) {
  std::mt19937_64 random(18);
  std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
  for (int i = 0; i < problem_count() / 10; ++i) {
    AxisState<float> start[3];
    AxisState<float> target[3];
    for (int axis = 0; axis < 3; ++axis) {
      start[axis] = {6 * uniform(random), 1.4F * uniform(random), uniform(random)};
      target[axis] = {6 * uniform(random), 1.4F * uniform(random), 0};
    }
    Trajectory<float> motions[3];
    ASSERT_EQ(plan_plane(start, target, {2.0F, 2.0F, 6.0F}, AxisLimits<float>::symmetric(6, 20, 100), motions), PlanResult::ok);
    for (int axis = 0; axis < 3; ++axis) {
      const TrajectorySegment<float>& last = motions[axis].segments[motions[axis].segment_count - 1];
      const AxisState<float> end = Trajectory<float>::advanced(last.start, last.jerk, last.duration_s);
      EXPECT_NEAR(end.position, target[axis].position, 1e-3F);
      EXPECT_NEAR(end.velocity, target[axis].velocity, 1e-3F);
      EXPECT_NEAR(motions[axis].duration_s, motions[0].duration_s, 0.0F);
    }
  }
}

TEST(TrajectoryFloat, ReplannedEveryMillisecondARobotIsNotSentAround) {
  std::mt19937_64 random(27);
  const auto uniform = [&random](double low, double high) {
    return static_cast<float>(std::uniform_real_distribution<double>(low, high)(random));
  };
  constexpr float kPeriod_s = 1e-3F;
  for (int i = 0; i < 10 + problem_count() / 500; ++i) {
    const PlaneLimits<float> plane{uniform(1, 3.5), uniform(1, 5), uniform(5, 60)};
    const AxisLimits<float> yaw = AxisLimits<float>::symmetric(uniform(5, 20), uniform(20, 60), uniform(100, 600));
    AxisState<float> state[3] = {{uniform(-6, 6), 0, 0}, {uniform(-4, 4), 0, 0}, {uniform(-3, 3), 0, 0}};
    const AxisState<float> target[3] = {{uniform(-6, 6), 0, 0}, {uniform(-4, 4), 0, 0}, {uniform(-3, 3), 0, 0}};
    double first_s = -1.0;
    double left_s = 1.0;
    for (int tick = 0; left_s > 2 * static_cast<double>(kPeriod_s); ++tick) {
      Trajectory<float> motions[3];
      ASSERT_EQ(plan_plane(state, target, plane, yaw, motions), PlanResult::ok);
      left_s = static_cast<double>(motions[0].duration_s);
      first_s = first_s < 0.0 ? left_s : first_s;
      ASSERT_LE(tick * static_cast<double>(kPeriod_s) + left_s, 1.05 * first_s + 0.05) << i << " in tick " << tick;
      for (int axis = 0; axis < 3; ++axis) {
        state[axis] = motions[axis].at(kPeriod_s);
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(state[axis].position, target[axis].position, 2e-3F);
    }
  }
}

}  // namespace
}  // namespace robot_core::reference
