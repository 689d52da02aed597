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

TEST(TrajectoryPlane, ADiagonalIsNoFasterThanAStraightRun) {
  const PlaneLimits<double> plane{2, 2, 6};
  const Limits yaw = Limits::symmetric(6, 20, 100);
  const State start[3] = {};
  double straight_s = 0.0;
  for (int degrees = 0; degrees < 360; degrees += 5) {
    const double angle = degrees * 3.14159265358979323846 / 180;
    const State target[3] = {{5 * std::cos(angle), 0, 0}, {5 * std::sin(angle), 0, 0}, {1, 0, 0}};
    Motion motions[3];
    ASSERT_EQ(plan_plane(start, target, plane, yaw, motions), PlanResult::ok);
    straight_s = degrees == 0 ? motions[0].duration_s : straight_s;
    EXPECT_NEAR(motions[0].duration_s, 5.0 / 2 + 2.0 / 2 + 2.0 / 6, 3e-6) << degrees;
    for (double time_s = 0; time_s < motions[0].duration_s; time_s += 0.01) {
      EXPECT_LE(std::hypot(motions[0].at(time_s).velocity, motions[1].at(time_s).velocity), 2 * (1 + 1e-12));
      EXPECT_LE(std::hypot(motions[0].at(time_s).acceleration, motions[1].at(time_s).acceleration), 2 * (1 + 1e-12));
      EXPECT_LE(std::hypot(motions[0].jerk_at(time_s), motions[1].jerk_at(time_s)), 6 * (1 + 1e-12));
    }
  }
}

TEST(TrajectoryPlane, RandomRunsKeepTheCircle) {
  std::mt19937_64 random(15);
  const PlaneLimits<double> plane{3, 3, 20};
  const Limits yaw = Limits::symmetric(20, 50, 500);
  std::uniform_real_distribution<double> uniform(-1, 1);
  double fastest = 0.0;
  int slower_than_square = 0;
  for (int i = 0; i < problem_count() / 20; ++i) {
    const State start[3] = {{6 * uniform(random), 0, 0}, {4 * uniform(random), 0, 0}, {3 * uniform(random), 4 * uniform(random), 0}};
    const State target[3] = {{6 * uniform(random), 1.5 * uniform(random), 0}, {4 * uniform(random), 1.5 * uniform(random), 0}, {}};
    Motion motions[3];
    ASSERT_EQ(plan_plane(start, target, plane, yaw, motions), PlanResult::ok);
    for (double share = 0; share <= 1; share += 0.01) {
      const double time_s = share * motions[0].duration_s;
      const double speed = std::hypot(motions[0].at(time_s).velocity, motions[1].at(time_s).velocity);
      EXPECT_LE(speed, 3 * (1 + 1e-9));
      EXPECT_LE(std::hypot(motions[0].at(time_s).acceleration, motions[1].at(time_s).acceleration), 3 * (1 + 1e-9));
      fastest = std::max(fastest, speed);
    }
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(motions[axis].at(motions[0].duration_s * (1 - 1e-15)).position, target[axis].position, 1e-9);
    }
    const Limits square = Limits::symmetric(3, 3, 20);
    const Fleet fleet = synchronised({{start[0], target[0], square}, {start[1], target[1], square}, {start[2], target[2], yaw}});
    slower_than_square += motions[0].duration_s > fleet.motions[0].duration_s * (1 + 1e-9) ? 1 : 0;
  }
  EXPECT_GT(fastest, 2.9);
  EXPECT_GT(slower_than_square, 0);
}

TEST(TrajectoryPlane, ReplannedEveryTickItStaysOnItsWay) {
  std::mt19937_64 random(19);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const PlaneLimits<double> plane{3, 3, 20};
  const Limits yaw = Limits::symmetric(20, 50, 500);
  constexpr double kPeriod_s = 0.01;
  for (int i = 0; i < 5 + problem_count() / 2000; ++i) {
    State state[3] = {{6 * uniform(random), 0, 0}, {4 * uniform(random), 0, 0}, {3 * uniform(random), 0, 0}};
    const State target[3] = {{6 * uniform(random), 0, 0}, {4 * uniform(random), 0, 0}, {}};
    double first_s = -1.0;
    double fastest = 0.0;
    double left_s = 1.0;
    for (double passed_s = 0.0; left_s > kPeriod_s; passed_s += kPeriod_s) {
      Motion motions[3];
      ASSERT_EQ(plan_plane(state, target, plane, yaw, motions), PlanResult::ok);
      left_s = motions[0].duration_s;
      first_s = first_s < 0.0 ? left_s : first_s;
      ASSERT_LE(passed_s + left_s, first_s * 1.001 + 1e-3);
      for (int axis = 0; axis < 3; ++axis) {
        state[axis] = motions[axis].at(kPeriod_s);
      }
      fastest = std::max(fastest, std::hypot(state[0].velocity, state[1].velocity));
    }
    EXPECT_LE(fastest, 3 * (1 + 1e-5));
    EXPECT_NEAR(state[0].position, target[0].position, 1e-4);
    EXPECT_NEAR(state[1].position, target[1].position, 1e-4);
  }
}

/// Largest speed and acceleration of a path, each divided by its limit.
struct LongestOverLimit {
  double speed = 0.0;
  double acceleration = 0.0;
};

LongestOverLimit longest(const Motion (&motions)[3], const PlaneLimits<double>& plane) {
  LongestOverLimit most;
  for (double time_s = 0; time_s < motions[0].duration_s; time_s += 1e-3) {
    const State x = motions[0].at(time_s);
    const State y = motions[1].at(time_s);
    most.speed = std::max(most.speed, std::hypot(x.velocity, y.velocity) / plane.speed_max);
    most.acceleration = std::max(most.acceleration, std::hypot(x.acceleration, y.acceleration) / plane.acceleration_max);
  }
  return most;
}

TEST(TrajectoryPlane, ATurnAtFullSpeedKeepsTheCircle) {
  std::mt19937_64 random(23);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const PlaneLimits<double> plane{3, 3, 20};
  const Limits yaw = Limits::symmetric(20, 50, 500);
  for (int i = 0; i < problem_count() / 20; ++i) {
    const double direction = 3.2 * uniform(random);
    const double speed = i % 2 == 0 ? 3.0 : 3.0 * std::abs(uniform(random));
    const State start[3] = {{0, speed * std::cos(direction), 0}, {0, speed * std::sin(direction), 0}, {}};
    const State target[3] = {{6 * uniform(random), 0, 0}, {6 * uniform(random), 0, 0}, {uniform(random), 0, 0}};
    Motion motions[3];
    ASSERT_EQ(plan_plane(start, target, plane, yaw, motions), PlanResult::ok);
    const LongestOverLimit most = longest(motions, plane);
    EXPECT_LE(most.speed, 1.002) << direction;
    EXPECT_LE(most.acceleration, 1.002) << direction;
    for (int axis = 0; axis < 3; ++axis) {
      expect_flawless(motions[axis], {start[axis], target[axis], axis < 2 ? Limits::symmetric(3, 3, 20) : yaw});
    }
  }
}

TEST(TrajectoryPlane, ANewTargetOnTheWayKeepsTheCircle) {
  std::mt19937_64 random(24);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const PlaneLimits<double> plane{3, 3, 20};
  const Limits yaw = Limits::symmetric(20, 50, 500);
  constexpr double kPeriod_s = 0.01;
  for (int i = 0; i < 20 + problem_count() / 1000; ++i) {
    State state[3] = {{6 * uniform(random), 0, 0}, {4 * uniform(random), 0, 0}, {}};
    State target[3] = {{6 * uniform(random), 0, 0}, {4 * uniform(random), 0, 0}, {}};
    Motion motions[3];
    ASSERT_EQ(plan_plane(state, target, plane, yaw, motions), PlanResult::ok);
    const double turn_s = motions[0].duration_s * std::abs(uniform(random));
    double first_s = -1.0;
    double fastest = 0.0;
    double passed_s = 0.0;
    for (double left_s = 100.0; left_s > kPeriod_s && passed_s < 60.0; passed_s += kPeriod_s) {
      if (first_s < 0.0 && passed_s > turn_s) {
        target[0].position = 6 * uniform(random);
        target[1].position = 4 * uniform(random);
      }
      ASSERT_EQ(plan_plane(state, target, plane, yaw, motions), PlanResult::ok);
      left_s = motions[0].duration_s;
      first_s = first_s < 0.0 && passed_s > turn_s ? passed_s + left_s : first_s;
      for (int axis = 0; axis < 3; ++axis) {
        state[axis] = motions[axis].at(kPeriod_s);
      }
      fastest = std::max(fastest, std::hypot(state[0].velocity, state[1].velocity));
    }
    EXPECT_LE(fastest, 3 * 1.002);
    // Later plans have more room than the first one after the turn.
    EXPECT_LE(passed_s, std::max(first_s, turn_s) * 1.001 + 0.05);
  }
}

TEST(TrajectoryPlane, ALowerLimitIsApproachedFromAbove) {
  // A referee lowers the speed limit while the robot drives.
  const PlaneLimits<double> plane{1.5, 3, 20};
  const State start[3] = {{0, 2.4, 0}, {0, 1.8, 0}, {}};
  const State target[3] = {{-1, 0, 0}, {4, 0, 0}, {}};
  Motion motions[3];
  ASSERT_EQ(plan_plane(start, target, plane, Limits::symmetric(20, 50, 500), motions), PlanResult::ok);
  const LongestOverLimit most = longest(motions, plane);
  EXPECT_LE(most.speed, 3.0 / 1.5 * 1.002);
  EXPECT_LE(most.acceleration, 1.002);
}

TEST(TrajectoryPlane, AStandTakesAsLongFromEveryDirection) {
  const PlaneLimits<double> plane{3, 2, 6};
  const State stand[3] = {};
  for (int degrees = 0; degrees < 360; degrees += 5) {
    const double angle = degrees * 3.14159265358979323846 / 180;
    const State start[3] = {{0, 2 * std::cos(angle), 0}, {0, 2 * std::sin(angle), 0}, {0, 1, 0}};
    Motion motions[3];
    ASSERT_EQ(plan_plane_velocity(start, stand, plane, Limits::symmetric(6, 20, 100), motions), PlanResult::ok);
    const double duration_s = motions[0].duration_s;
    EXPECT_NEAR(duration_s, 2.0 / 2 + 2.0 / 6, 3e-6) << degrees;
    for (double share = 0.0; share < 1.0; share += 0.01) {
      const State x = motions[0].at(share * duration_s);
      const State y = motions[1].at(share * duration_s);
      EXPECT_NEAR(x.velocity * std::sin(angle), y.velocity * std::cos(angle), 1e-12) << "leaves its line at " << degrees;
      EXPECT_LE(std::hypot(x.acceleration, y.acceleration), 2 * (1 + 1e-12));
      EXPECT_LE(std::hypot(motions[0].jerk_at(share * duration_s), motions[1].jerk_at(share * duration_s)), 6 * (1 + 1e-12));
    }
    for (const Motion& motion : motions) {
      EXPECT_EQ(motion.duration_s, duration_s);
      EXPECT_EQ(motion.at(duration_s).velocity, 0.0);
    }
  }
}

TEST(TrajectoryPlane, BangBangOfADiagonalIsNoFasterThanAStraightRun) {
  const PlaneLimits<double> plane{2, 2, 6};
  const State start[3] = {};
  for (int degrees = 0; degrees < 360; degrees += 5) {
    const double angle = degrees * 3.14159265358979323846 / 180;
    const State target[3] = {{5 * std::cos(angle), 0, 0}, {5 * std::sin(angle), 0, 0}, {1, 0, 0}};
    Motion motions[3];
    ASSERT_EQ(plan_plane_bang_bang(start, target, plane, Limits::symmetric(6, 20, 100), motions), PlanResult::ok);
    EXPECT_NEAR(std::max(motions[0].duration_s, motions[1].duration_s), 5.0 / 2 + 2.0 / 2, 3e-6) << degrees;
    for (double time_s = 0; time_s < motions[0].duration_s; time_s += 0.01) {
      EXPECT_LE(std::hypot(motions[0].at(time_s).velocity, motions[1].at(time_s).velocity), 2 * (1 + 1e-12));
      EXPECT_LE(std::hypot(motions[0].at(time_s).acceleration, motions[1].at(time_s).acceleration), 2 * (1 + 1e-6));
    }
  }
}

/// Measurements of a robot that plans anew in every tick.
struct Followed {
  double speed = 0.0;         ///< highest speed divided by its limit
  double acceleration = 0.0;  ///< highest acceleration divided by its limit
  double distance = 0.0;      ///< largest distance from the target in the second half
  double ripple = 0.0;        ///< largest deviation from the target's acceleration in the second half
};

template <typename TargetAt>
Followed follow(const TargetAt& target_at) {
  const PlaneLimits<double> plane{3, 3, 20};
  const Limits yaw = Limits::symmetric(20, 50, 500);
  constexpr double kPeriod_s = 1e-3;
  constexpr int kTicks = 8000;
  State state[3] = {{-2, 0, 0}, {1, 0, 0}, {}};
  Followed result;
  for (int tick = 0; tick < kTicks; ++tick) {
    State target[3];
    target_at(tick * kPeriod_s, target);
    Motion motions[3];
    EXPECT_EQ(plan_plane(state, target, plane, yaw, motions, Target::moving_on), PlanResult::ok);
    for (int axis = 0; axis < 3; ++axis) {
      state[axis] = motions[axis].at(kPeriod_s);
    }
    target_at((tick + 1) * kPeriod_s, target);
    result.speed = std::max(result.speed, std::hypot(state[0].velocity, state[1].velocity) / plane.speed_max);
    result.acceleration = std::max(result.acceleration, std::hypot(state[0].acceleration, state[1].acceleration) / plane.acceleration_max);
    if (tick >= kTicks / 2) {
      result.distance =
          std::max(result.distance, std::hypot(state[0].position - target[0].position, state[1].position - target[1].position));
      result.ripple = std::max(result.ripple,
                               std::hypot(state[0].acceleration - target[0].acceleration, state[1].acceleration - target[1].acceleration));
    }
  }
  return result;
}

TEST(TrajectoryPlane, FollowsAnEvenTargetAtOneKilohertzWithoutJitter) {
  const Followed followed = follow([](double time_s, State(&target)[3]) {
    target[0] = {0.5 * time_s, 0.5, 0};
    target[1] = {0.7 * time_s, 0.7, 0};
    target[2] = {1, 0, 0};
  });
  EXPECT_LE(followed.speed, 1 + 1e-5);
  EXPECT_LE(followed.acceleration, 1 + 1e-5);
  EXPECT_LE(followed.distance, 1e-12);
  EXPECT_EQ(followed.ripple, 0.0);
}

TEST(TrajectoryPlane, FollowsACirclingTargetAtOneKilohertzWithoutJitter) {
  // The planner is not given the target's acceleration; it observes the change in the next tick. Its response is then smaller than the
  // change that the jerk can cause in one tick.
  const Followed followed = follow([](double time_s, State(&target)[3]) {
    const double turn = 0.8;
    const double sine = std::sin(turn * time_s);
    const double cosine = std::cos(turn * time_s);
    target[0] = {sine, turn * cosine, -turn * turn * sine};
    target[1] = {cosine, -turn * sine, -turn * turn * cosine};
    target[2] = {turn * time_s, turn, 0};
  });
  EXPECT_LE(followed.speed, 1 + 1e-5);
  EXPECT_LE(followed.acceleration, 1 + 1e-5);
  EXPECT_LE(followed.distance, 1e-3);
  EXPECT_LE(followed.ripple, 20 * 1e-3);
}

}  // namespace
}  // namespace robot_core::reference
