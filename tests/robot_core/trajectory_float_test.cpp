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
    // Rounding the ends may close the way that was shortest; apart from that the durations agree.
    Motion exact;
    const auto widened = [](const AxisState<float>& s) {
      return State{static_cast<double>(s.position), static_cast<double>(s.velocity), static_cast<double>(s.acceleration)};
    };
    if (plan_position(widened(start), widened(target), task.limits, exact) != PlanResult::ok) {
      continue;  // a target on the edge, which its rounding crosses
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

}  // namespace
}  // namespace robot_core::reference
