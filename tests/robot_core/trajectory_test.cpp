#include "robot_core/trajectory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "trajectory_reference.h"

namespace robot_core::reference {
namespace {

/// HEATSOAK_TRAJECTORY_PROBLEMS=1000000 is the long run.
int problem_count() {
  const char* const asked = std::getenv("HEATSOAK_TRAJECTORY_PROBLEMS");
  return asked != nullptr ? std::atoi(asked) : 20'000;
}

std::string text(const Task& task) {
  std::ostringstream out;
  out.precision(17);
  const Limits& l = task.limits;
  out << "{{" << task.start.position << ", " << task.start.velocity << ", " << task.start.acceleration << "}, {" << task.target.position
      << ", " << task.target.velocity << ", " << task.target.acceleration << "}, {" << l.velocity_max << ", " << l.velocity_min << ", "
      << l.acceleration_max << ", " << l.acceleration_min << ", " << l.jerk_max << "}}";
  return out.str();
}

Motion planned(const Task& task) {
  Motion motion;
  EXPECT_EQ(plan_position(task.start, task.target, task.limits, motion), PlanResult::ok) << text(task);
  return motion;
}

double duration_s(const Task& task) { return planned(task).duration_s; }

void expect_flawless(const Motion& motion, const Task& task, double judged_from_s = 0.0, double most = 1e-10) {
  const Flaws flaws = flaws_of(motion, task, judged_from_s);
  EXPECT_LE(flaws.end, most) << text(task);
  EXPECT_LE(flaws.gap, 1e-10) << text(task);
  EXPECT_LE(flaws.limit, most) << text(task);
  EXPECT_LE(flaws.jerk, 1e-12) << text(task);
  EXPECT_LE(flaws.order, 1e-14) << text(task);
}

Task rest_to_rest(double distance, double velocity, double acceleration, double jerk) {
  return {{}, {distance, 0, 0}, Limits::symmetric(velocity, acceleration, jerk)};
}

TEST(TrajectoryClosedForm, RestToRest) {
  EXPECT_NEAR(duration_s(rest_to_rest(1, 100, 100, 6)), 4 * std::cbrt(1.0 / 12), 1e-14);                    // jerk alone
  EXPECT_NEAR(duration_s(rest_to_rest(8, 100, 2, 6)), 2.0 / 6 + std::sqrt(4.0 / 36 + 4 * 8.0 / 2), 1e-14);  // holds the acceleration
  EXPECT_NEAR(duration_s(rest_to_rest(8, 2, 2, 6)), 8.0 / 2 + 2.0 / 2 + 2.0 / 6, 1e-14);                    // and cruises
  EXPECT_NEAR(duration_s(rest_to_rest(8, 0.5, 2, 6)), 8.0 / 0.5 + 2 * std::sqrt(0.5 / 6), 1e-14);           // cruises, holds nothing
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
  // Ends on one parabola of full jerk: nothing else gets there as early.
  for (const double a0 : {-1.2, -0.3, 0.0, 0.4, 1.2}) {
    for (const double jerk : {6.0, -6.0}) {
      const State start{0.3, 0.4, a0};
      const State target = Motion::advanced(start, jerk, 0.1);
      EXPECT_NEAR(duration_s({start, target, Limits::symmetric(3, 2, 6)}), 0.1, 1e-12);
    }
  }
}

TEST(TrajectoryClosedForm, AlmostNothingToDo) {
  // The way is 1e-11 of the one that the acceleration would take to vanish, and yet no rounding error.
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
    // What was inside comes no further out than the start forces it to, and everything is inside later on.
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
      ++missed;  // by the search: a motion that exists for less than one of its samples
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
  // The bound knows nothing of structures or directions: it excludes that some other kind of motion is faster.
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
  // A grid cannot decide where nearly all of the time is a cruise.
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
      // On the last segments (and where the state just touches a limit) the duration grows like the cube root of a
      // rounding error of the state: that is the problem's nature, not the planner's.
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

/// Each of these was once sent around: on the way, at `share` of its duration, it was planned to take seconds longer.
TEST(TrajectoryReplan, CasesThatWentWrong) {
  struct Case {
    double share;
    Task task;
  };
  const Case cases[] = {
      // the start will break a velocity limit, but arrives before
      {0.95,
       {{-1.3849627029927793, -1.4583738602568976, 3.0879245244189053},
        {-4.2281798274856177, 0.10467012822382227, 2.382051499752083},
        {0.16188541914658056, -1.5938739957459613, 7.9527111346092889, -3.865207892919901, 6.3219638393939492}}},
      {0.8,
       {{6.6289636626697774, 5.7939506672346468, -3.3240499746914489},
        {9.5045937756877326, -4.6676140060676135, -5.3045210948464376},
        {8.733730632074538, -4.8277262413231234, 2.4718111701109131, -6.472977676351559, 7.1143139821351005}}},
      // arrives the very moment a gap of durations ends
      {0.5,
       {{-1.7109956702844062, -6.0514064799713001, -0.57329656788216199},
        {-5.5732032028554537, 2.0935719717032697, 2.9708902201986187},
        {2.8757200213734722, -6.3729231326157834, 3.9790655879581007, -3.1504705215833106, 4.3557003871238491}}},
      // or begins
      {0.5,
       {{-10.059461988003882, -1.9633111249166904, 3.0439095524591226},
        {-6.2203862696415939, 4.0125506853290682, 2.4866115097681871},
        {9.5738860276408744, -6.515107009148621, 8.4466810948048145, -3.0783401418989276, 5.209872403988606}}},
      // acceleration of almost nothing, whose square is lost beside the velocities
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

TEST(TrajectoryReplan, ConvergesOnAMovingTarget) {
  std::mt19937_64 random(8);
  constexpr double kPeriod_s = 0.01;
  for (int i = 0; i < problem_count() / 200; ++i) {
    Task task = random_task(random);
    task.limits = Limits::symmetric(3, 4, 30);
    task.start.velocity = task.start.acceleration = 0.0;
    // The target circles; its velocity is told, its acceleration is not.
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
    // Whoever goes there straight may be there first, but nowhere before is the target met.
    EXPECT_LE(duration_s(met), motion.duration_s * (1 + 1e-9)) << text(task);
    for (const double share : {0.3, 0.6, 0.9, 0.98}) {
      met.target.position = task.target.position + task.target.velocity * share * motion.duration_s;
      ++asked;
      undecided += is_impossible(met, share * motion.duration_s, 300) ? 0 : 1;
    }
  }
  EXPECT_LE(undecided, asked / 100) << asked;
}

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
    // The end velocity and position of the last segment, whose acceleration then drops.
    const auto& last = motion.segments[motion.segment_count - 1];
    const State end = Motion::advanced(last.start, 0, last.duration_s);
    EXPECT_NEAR(end.position, task.target.position, 1e-9 * (1 + motion.duration_s));
    EXPECT_NEAR(end.velocity, task.target.velocity, 1e-9);
    EXPECT_NEAR(duration_s(task), motion.duration_s, 1e-2 * (1 + motion.duration_s)) << text(task);
    EXPECT_GE(duration_s(task), motion.duration_s * (1 - 1e-9)) << text(task);
  }
}

struct Fleet {
  std::vector<Task> tasks;
  std::vector<Motion> motions;
};

Fleet synchronised(std::vector<Task> tasks) {
  Fleet fleet{std::move(tasks), {}};
  std::vector<State> start;
  std::vector<State> target;
  std::vector<Limits> limits;
  for (const Task& task : fleet.tasks) {
    start.push_back(task.start);
    target.push_back(task.target);
    limits.push_back(task.limits);
  }
  fleet.motions.resize(fleet.tasks.size());
  EXPECT_EQ(plan_synchronised(static_cast<int>(fleet.tasks.size()), start.data(), target.data(), limits.data(), fleet.motions.data()),
            PlanResult::ok);
  return fleet;
}

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
  // Of the last axis both legs would be held, if one took each alone; in truth only one is.
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
  // The first axis moves so shortly that its velocity hardly changes.
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
      // One may have to wait a million times its own duration for the other.
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

TEST(TrajectoryPlane, ReplannedTurnStaysInsideTheSquare) {
  // A turn at full speed leaves the circle for a moment, as documented.
  const PlaneLimits<double> plane{3, 3, 20};
  const State start[3] = {{0, 3, 0}, {0, 0, 0}, {}};
  const State target[3] = {{0, 0, 0}, {4, 0, 0}, {}};
  Motion motions[3];
  ASSERT_EQ(plan_plane(start, target, plane, Limits::symmetric(20, 50, 500), motions), PlanResult::ok);
  for (double time_s = 0; time_s < motions[0].duration_s; time_s += 0.01) {
    EXPECT_LE(std::hypot(motions[0].at(time_s).velocity, motions[1].at(time_s).velocity), 3 * 1.4142136);
  }
}

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
  task.target = {1, -1.9, 1.9};  // who accelerates so much at that velocity was slower than -2 before
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
    plan_plane(start, target, {any(), any(), any()}, limits[2], motions);
  }
}

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

#ifdef HEATSOAK_SOURCE_DIR
TEST(TrajectoryFreestanding, FloatBuildNeedsNothing) {
  if (std::system("c++ --version > /dev/null 2>&1 && nm --version > /dev/null 2>&1") != 0) {
    GTEST_SKIP() << "no compiler here";
  }
  const std::string object = testing::TempDir() + "heatsoak_trajectory.o";
  const std::string source = HEATSOAK_SOURCE_DIR;
  ASSERT_EQ(std::system(("c++ -std=c++20 -O2 -ffreestanding -fno-exceptions -fno-rtti -ffp-contract=off -Wdouble-promotion -Werror "
                         "-DROBOT_CORE_WITHOUT_DOUBLE -I'" +
                         source + "' -c '" + source + "/robot_core/trajectory.cpp' -o '" + object + "'")
                            .c_str()),
            0);
  EXPECT_NE(std::system(("nm -u '" + object + "' | grep .").c_str()), 0) << "undefined symbols";
}
#endif

}  // namespace
}  // namespace robot_core::reference
