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

TEST(TrajectorySynchronised, ArriveTogetherWithinLimits) {
  std::mt19937_64 random(12);
  for (int i = 0; i < problem_count() / 2; ++i) {
    std::vector<Task> tasks;
    for (int axis = 0; axis < 3; ++axis) {
      tasks.push_back(i % 4 == 3 ? violating_task(random) : random_task(random));
    }
    const Fleet fleet = synchronised(tasks);
    double slowest_s = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      const Motion& motion = fleet.motions[axis];
      expect_flawless(motion, tasks[axis], i % 4 == 3 ? std::numeric_limits<double>::infinity() : 0.0);
      EXPECT_EQ(motion.duration_s, fleet.motions[0].duration_s);
      slowest_s = std::max(slowest_s, duration_s(tasks[axis]));
    }
    EXPECT_GE(fleet.motions[0].duration_s, slowest_s * (1 - 1e-12));
    if (HasFailure()) {
      ADD_FAILURE() << text(tasks[0]) << text(tasks[1]) << text(tasks[2]);
      break;
    }
  }
}

TEST(TrajectorySynchronised, CasesThatWentWrong) {
  // Solved separately, both legs of the last axis would be held; in fact only one is.
  const std::vector<Task> one_held{
      {{4.1342772643622308, 0.92769367053839558, 2.6596765939253668},
       {0.67660242372466717, 0.41790150715411345, 7.6210073756017884},
       {5.7142763108814192, -3.6436632351696008, 9.4997947477658489, -5.4871522267626602, 8.3565380910404485}},
      {{-6.8940406065243707, 0.10054581006264662, -2.824301353315795},
       {7.4916107807453383, -0.972459244245925, -1.6126321395847301},
       {8.3095457218969919, -4.053769263642435, 3.4664771902913096, -5.8057014498208366, 1.7173197150734116}},
      {{1.1838750051890474, -1.8831222900618139, 1.5392788654838179},
       {0.21644187988598998, 3.4274903332804829, 6.1088751579971019},
       {4.9352966295886551, -6.5700481754489743, 9.2506697560111526, -0.43871999231199876, 9.5078357619318155}}};
  // The first axis moves over such a short distance that its velocity hardly changes.
  const std::vector<Task> short_one{
      {{-2.2461964923963686e-05, 0.32443138869962523, 0},
       {0.00044064030905026586, 0.32443138869962523, 0},
       {0.32443138869962523, -0.043084469709123052, 4.5579264059585706e-09, -2.3160179603451618e-09, 1.7060774948792058e-11}},
      {{1.6825656506060351e-09, -0.0009611440441818107, 1.2118107103513456},
       {0, 0.00054538927732812831, 0},
       {0.0017541660152104123, -0.0009611440441818107, 3.4726549506089515, -1.4380945025055674, 1393.0558445774088}}};
  for (const std::vector<Task>& tasks : {one_held, short_one}) {
    const Fleet fleet = synchronised(tasks);
    for (std::size_t axis = 0; axis < tasks.size(); ++axis) {
      expect_flawless(fleet.motions[axis], tasks[axis], 0.0, 1e-8);
    }
  }
}

TEST(TrajectorySynchronised, ExtremeScales) {
  std::mt19937_64 random(13);
  for (int i = 0; i < problem_count() / 4; ++i) {
    std::vector<Task> tasks{extreme_task(random), extreme_task(random)};
    const Fleet fleet = synchronised(tasks);
    for (int axis = 0; axis < 2; ++axis) {
      // One axis may have to wait a million times its own duration for the other.
      expect_flawless(fleet.motions[axis], tasks[axis], 0.0, 1e-8);
    }
    if (HasFailure()) {
      ADD_FAILURE() << text(tasks[0]) << text(tasks[1]);
      break;
    }
  }
}

TEST(TrajectorySynchronised, NoEarlierTimeSuitsAll) {
  std::mt19937_64 random(14);
  int delayed = 0;
  int undecided = 0;
  int asked = 0;
  for (int i = 0; i < problem_count() / 10; ++i) {
    std::vector<Task> tasks{random_task(random), random_task(random), random_task(random)};
    const Fleet fleet = synchronised(tasks);
    double slowest_s = 0.0;
    for (const Task& task : tasks) {
      slowest_s = std::max(slowest_s, duration_s(task));
    }
    const double together_s = fleet.motions[0].duration_s;
    if (together_s < slowest_s * 1.02) {
      continue;
    }
    ++delayed;  // an axis that could arrive earlier cannot arrive together with the slowest
    for (const double share : {0.1, 0.3, 0.5, 0.7, 0.9}) {
      const double time_s = slowest_s + share * (together_s - slowest_s);
      bool is_excluded = false;
      for (const Task& task : tasks) {
        is_excluded = is_excluded || is_impossible(task, time_s, 500);
      }
      ++asked;
      undecided += is_excluded ? 0 : 1;
    }
  }
  EXPECT_GT(delayed, 0);
  EXPECT_LE(undecided, asked / 50) << asked;
}

TEST(TrajectorySynchronised, FromRestToRestIsStraight) {
  const Limits limits = Limits::symmetric(2, 2, 6);
  const Fleet fleet = synchronised({{{}, {3, 0, 0}, limits}, {{}, {-1, 0, 0}, limits}, {{}, {0, 0, 0}, limits}});
  for (double share = 0.0; share <= 1.0; share += 0.01) {
    const double time_s = share * fleet.motions[0].duration_s;
    EXPECT_NEAR(fleet.motions[1].at(time_s).position, -fleet.motions[0].at(time_s).position / 3, 1e-13);
    EXPECT_NEAR(fleet.motions[2].at(time_s).position, 0.0, 1e-13);
  }
}

TEST(TrajectorySynchronised, AxesThatArriveTogetherButForRoundingStayTogether) {
  // Each task is one segment of full jerk, whose next arrival comes much later. Time is scaled so that all last equally long.
  std::mt19937_64 random(28);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  int tried = 0;
  int late = 0;
  for (int i = 0; i < problem_count() / 10; ++i) {
    std::vector<Task> tasks;
    double common_s = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      Task task = random_task(random);
      const double time_s = (0.1 + 0.9 * uniform(random)) * (task.limits.acceleration_max - task.start.acceleration) / task.limits.jerk_max;
      task.target = Motion::advanced(task.start, task.limits.jerk_max, time_s);
      common_s = axis == 0 ? time_s : common_s;
      tasks.push_back(scaled(task, 1.0, common_s / time_s));
    }
    Motion motions[3];
    const State start[3] = {tasks[0].start, tasks[1].start, tasks[2].start};
    const State target[3] = {tasks[0].target, tasks[1].target, tasks[2].target};
    const Limits limits[3] = {tasks[0].limits, tasks[1].limits, tasks[2].limits};
    if (plan_synchronised(3, start, target, limits, motions) != PlanResult::ok) {
      continue;
    }
    ++tried;
    late += motions[0].duration_s > common_s * (1 + 1e-9) ? 1 : 0;
  }
  EXPECT_GT(tried, problem_count() / 100);
  EXPECT_LE(late, tried / 1000) << tried;
}

}  // namespace
}  // namespace robot_core::reference
