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

TEST(TrajectoryReplan, OnTheWayTheArrivalStays) {
  std::mt19937_64 random(6);
  double worst = 0.0;
  double worst_late = 0.0;
  for (int i = 0; i < problem_count() / 10; ++i) {
    const Task task = random_task(random);
    const Motion motion = planned(task);
    for (const double share : {0.01, 0.2, 0.5, 0.8, 0.95}) {
      Task rest = task;
      const double passed_s = share * motion.duration_s;
      rest.start = motion.at(passed_s);
      // On the last segments, and if the state just touches a limit, the duration grows like the cube root of a rounding error of the
      // state. This is a property of the problem, not of the planner.
      const double change_s = std::abs(duration_s(rest) - (motion.duration_s - passed_s)) / motion.duration_s;
      const bool is_last = motion.segment_at(passed_s) + 2 >= motion.segment_count;
      if (change_s > 1e-5) {
        ADD_FAILURE() << change_s << " at " << share << " " << text(task) << "\nrest " << text(rest);
      }
      (is_last ? worst_late : worst) = std::max(is_last ? worst_late : worst, change_s);
    }
  }
  EXPECT_LE(worst, 1e-9);
  EXPECT_LE(worst_late, 1e-5);
}

/// Regression: planned anew at `share` of the duration, each of these cases once took seconds longer.
TEST(TrajectoryReplan, CasesThatWentWrong) {
  struct Case {
    double share = 0.0;
    Task task;
  };
  const Case cases[] = {
      // the start will violate a velocity limit, but arrives before
      {0.95,
       {{-1.3849627029927793, -1.4583738602568976, 3.0879245244189053},
        {-4.2281798274856177, 0.10467012822382227, 2.382051499752083},
        {0.16188541914658056, -1.5938739957459613, 7.9527111346092889, -3.865207892919901, 6.3219638393939492}}},
      {0.8,
       {{6.6289636626697774, 5.7939506672346468, -3.3240499746914489},
        {9.5045937756877326, -4.6676140060676135, -5.3045210948464376},
        {8.733730632074538, -4.8277262413231234, 2.4718111701109131, -6.472977676351559, 7.1143139821351005}}},
      // arrives exactly when a gap of durations ends
      {0.5,
       {{-1.7109956702844062, -6.0514064799713001, -0.57329656788216199},
        {-5.5732032028554537, 2.0935719717032697, 2.9708902201986187},
        {2.8757200213734722, -6.3729231326157834, 3.9790655879581007, -3.1504705215833106, 4.3557003871238491}}},
      // arrives exactly when a gap begins
      {0.5,
       {{-10.059461988003882, -1.9633111249166904, 3.0439095524591226},
        {-6.2203862696415939, 4.0125506853290682, 2.4866115097681871},
        {9.5738860276408744, -6.515107009148621, 8.4466810948048145, -3.0783401418989276, 5.209872403988606}}},
      // tiny acceleration, whose square is lost to rounding beside the velocities
      {0.95,
       {{2.1275293786859013, 7.7288535564820897, -0.34162519089856147},
        {-5.6747830135758255, -8.1954059053224722, -0.9786894263086241},
        {9.2916114767268212, -8.6823400354729436, 8.2631773767000514, -6.0078672411617777, 4.0875214869951444}}},
      {0.95,
       {{1.1395134416626396, -0.73126505407616138, -1.6828405937352544},
        {0.48928553120241919, -0.33726908086607521, -0.3051710229777691},
        {4.4806208212544609, -2.8488325346480061, 4.8260296650017329, -4.2994153740597421, 6.5487609424786912}}},
  };
  for (const Case& c : cases) {
    const Motion motion = planned(c.task);
    Task rest = c.task;
    rest.start = motion.at(c.share * motion.duration_s);
    EXPECT_NEAR(duration_s(rest), (1 - c.share) * motion.duration_s, 1e-5) << text(rest);
  }
}

TEST(TrajectoryReplan, ASegmentOfFullJerkIsFoundFromAnywhere) {
  // No motion changes an acceleration faster, and hardly any other arrives as early: rounding must not hide it.
  std::mt19937_64 random(26);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  int found = 0;
  for (int i = 0; i < problem_count(); ++i) {
    Task task = random_task(random);
    const double jerk = i % 2 == 0 ? task.limits.jerk_max : -task.limits.jerk_max;
    const double limit = i % 2 == 0 ? task.limits.acceleration_max : task.limits.acceleration_min;
    const double time_s = uniform(random) * (limit - task.start.acceleration) / jerk;
    task.target = Motion::advanced(task.start, jerk, time_s);
    Motion motion;
    if (plan_position(task.start, task.target, task.limits, motion) != PlanResult::ok) {
      continue;  // its end is too fast, or it is unreachable within the limits
    }
    ++found;
    ASSERT_LE(motion.duration_s, time_s * (1 + 1e-9) + 1e-12) << text(task);
    expect_flawless(motion, task);
  }
  EXPECT_GT(found, problem_count() / 4);
}

TEST(TrajectoryReplan, EveryTickTowardsARestingTarget) {
  std::mt19937_64 random(7);
  constexpr double kPeriod_s = 0.01;
  for (int i = 0; i < problem_count() / 200; ++i) {
    Task task = random_task(random);
    const Task first = task;
    const double first_s = duration_s(task);
    if (first_s > 30.0) {
      continue;
    }
    double passed_s = 0.0;
    for (double left_s = first_s; left_s > kPeriod_s; passed_s += kPeriod_s) {
      const Motion motion = planned(task);
      left_s = motion.duration_s;
      ASSERT_LE(passed_s + left_s, first_s + 1e-4) << text(task) << " first " << text(first);
      task.start = motion.at(kPeriod_s);
    }
  }
}

/// An axis that passes a fixed position at speed has little room near the arrival: if rounding makes it late, it must come back. That
/// happened in one run in four before neighbouring arrivals counted as one; a few such runs remain.
TEST(TrajectoryReplan, AxesThatFlyByAFixedPlaceSeldomLoseTheirArrival) {
  std::mt19937_64 random(5);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  constexpr double kTick_s = 0.01;
  constexpr int kRuns = 300;
  int lost = 0;
  for (int run = 0; run < kRuns; ++run) {
    AxisLimits<double> limits[3];
    AxisState<double> now[3];
    AxisState<double> target[3];
    for (int axis = 0; axis < 3; ++axis) {
      limits[axis] = AxisLimits<double>::symmetric(between(1.0, 3.0), between(1.0, 5.0), between(5.0, 60.0));
      now[axis] = {between(-6.0, 6.0), 0.0, 0.0};
      target[axis] = {between(-6.0, 6.0), axis < 2 ? between(-0.6, 0.6) * limits[axis].velocity_max : 0.0, 0.0};
    }
    Trajectory<double> trajectories[3];
    double passed_s = 0.0;
    double arrival_s = 0.0;
    do {
      ASSERT_EQ(plan_synchronised(3, now, target, limits, trajectories), PlanResult::ok);
      const double expected_s = passed_s + trajectories[0].duration_s;
      if (passed_s > 0.0 && expected_s > arrival_s + 0.01) {
        ++lost;
        break;
      }
      arrival_s = expected_s;
      for (int axis = 0; axis < 3; ++axis) {
        now[axis] = trajectories[axis].at(kTick_s);
      }
      passed_s += kTick_s;
    } while (arrival_s - passed_s > 1.5 * kTick_s);
  }
  EXPECT_LE(lost, kRuns / 20);
}

TEST(TrajectoryReplan, ConvergesOnAMovingTarget) {
  std::mt19937_64 random(8);
  constexpr double kPeriod_s = 0.01;
  for (int i = 0; i < problem_count() / 200; ++i) {
    Task task = random_task(random);
    task.limits = Limits::symmetric(3, 4, 30);
    task.start.velocity = task.start.acceleration = 0.0;
    // The target moves on a circle. The planner gets its velocity but not its acceleration.
    const double omega = std::uniform_real_distribution<double>(0.1, 0.8)(random);
    double time_s = 0.0;
    const auto target = [&](double at_s) { return State{std::sin(omega * at_s), omega * std::cos(omega * at_s), 0}; };
    for (; time_s < 20.0; time_s += kPeriod_s) {
      task.target = target(time_s);
      Motion motion;
      ASSERT_EQ(plan_position(task.start, task.target, task.limits, motion, Target::moving_on), PlanResult::ok);
      task.start = motion.at(kPeriod_s);
    }
    EXPECT_NEAR(task.start.position, target(time_s).position, 2e-3) << omega;
    EXPECT_NEAR(task.start.velocity, target(time_s).velocity, 2e-2) << omega;
  }
}

TEST(TrajectoryMovingTarget, IsMetWhereItIsByThen) {
  std::mt19937_64 random(9);
  int asked = 0;
  int undecided = 0;
  for (int i = 0; i < problem_count() / 10; ++i) {
    Task task = random_task(random);
    task.target.velocity *= 0.9;
    Motion motion;
    ASSERT_EQ(plan_position(task.start, task.target, task.limits, motion, Target::moving_on), PlanResult::ok);
    Task met = task;
    met.target = {task.target.position + task.target.velocity * motion.duration_s, task.target.velocity, 0};
    expect_flawless(motion, met);
    // A direct path may be there first, but the target is not met earlier anywhere.
    EXPECT_LE(duration_s(met), motion.duration_s * (1 + 1e-9)) << text(task);
    for (const double share : {0.3, 0.6, 0.9, 0.98}) {
      met.target.position = task.target.position + task.target.velocity * share * motion.duration_s;
      ++asked;
      undecided += is_impossible(met, share * motion.duration_s, 300) ? 0 : 1;
    }
  }
  EXPECT_LE(undecided, asked / 100) << asked;
}

}  // namespace
}  // namespace robot_core::reference
