// Arrivals at the edge of the reachable set, and the accuracy of the end that `ok` guarantees.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "robot_core/trajectory.h"
#include "trajectory_expectations.h"
#include "trajectory_reference.h"

namespace robot_core::reference {
namespace {

/// Returns a log-uniform number between 1/span and span.
double scale_within(std::mt19937_64& random, double span) { return std::exp(uniform(random, -std::log(span), std::log(span))); }

Limits limits_within(std::mt19937_64& random, double span) {
  const double velocity = scale_within(random, span);
  const double acceleration = scale_within(random, span);
  return {velocity, -velocity * scale_within(random, 3), acceleration, -acceleration * scale_within(random, 3), scale_within(random, span)};
}

struct Built {
  Task task;
  double duration_s = 0.0;
};

/// Returns a start inside the limits and the end of segments of full or zero jerk, as long as they keep the limits.
Built built_of_segments(std::mt19937_64& random, double span, int segments) {
  Built built;
  const Limits l = built.task.limits = limits_within(random, span);
  State s{uniform(random, -3, 3), uniform(random, l.velocity_min, l.velocity_max), uniform(random, l.acceleration_min, l.acceleration_max)};
  const auto keeps = [&l](double velocity) { return velocity <= l.velocity_max && velocity >= l.velocity_min; };
  if (!keeps(s.velocity + s.acceleration * std::abs(s.acceleration) / 2 / l.jerk_max)) {
    s.acceleration = 0.0;
  }
  built.task.start = s;
  for (int i = 0; i < segments; ++i) {
    const double jerk = l.jerk_max * (static_cast<int>(random() % 3) - 1);
    const double longest_s = std::min(2 * l.acceleration_max / l.jerk_max, 4 * l.velocity_max / l.acceleration_max);
    const double time_s = std::pow(10.0, uniform(random, -2, 0)) * longest_s;
    const State end = Motion::advanced(s, jerk, time_s);
    const double turn_s = jerk == 0.0 ? 0.0 : std::clamp(-s.acceleration / jerk, 0.0, time_s);
    if (keeps(end.velocity) && keeps(Motion::advanced(s, jerk, turn_s).velocity) && end.acceleration <= l.acceleration_max &&
        end.acceleration >= l.acceleration_min) {
      s = end;
      built.duration_s += time_s;
    }
  }
  built.task.target = s;
  return built;
}

TEST(TrajectoryArrival, AMotionOfAFewSegmentsIsNotPassedOver) {
  // Many of these ends lie at the edge of the reachable set: a velocity rounding error beyond it, the next arrival comes much later.
  std::mt19937_64 random(27);
  int planned_count = 0;
  for (int i = 0; i < problem_count(); ++i) {
    const double span = i % 3 == 0 ? 2 : i % 3 == 1 ? 10 : 100;
    const Built built = built_of_segments(random, span, 1 + i % 7);
    Motion motion;
    const PlanResult result = plan_position(built.task.start, built.task.target, built.task.limits, motion);
    if (built.duration_s == 0.0 || result == PlanResult::target_without_approach) {
      continue;
    }
    ASSERT_EQ(result, PlanResult::ok) << text(built.task);
    ++planned_count;
    ASSERT_LE(motion.duration_s, built.duration_s * (1 + 1e-9) + 1e-6) << text(built.task);
    expect_flawless(motion, built.task);
  }
  EXPECT_GT(planned_count, problem_count() * 9 / 10);
}

/// Each of these cases once resulted in durations of seconds to hours.
TEST(TrajectoryArrival, OnTheRimOfWhatCanBeReached) {
  const Built cases[] = {
      // at the start of a gap of durations
      {{{-1.2209526553857475, 4.3493034027278572, -0.011518753392435827},
        {-1.1855706733472293, 4.349213053668195, -0.026716204786281061},
        {4.4952624907672201, -2.0004400605220716, 0.16791772952061237, -0.07737296974799017, 4.6842162404259433}},
       0.00813514883},
      // at its end
      {{{1.8024781920275004, 2.4051517487057064, 0.11106072841168313},
        {1.8550739174708297, 2.4062301608325396, 0.016823405417416434},
        {8.8168118012167813, -5.3393098469241362, 0.68269944077670031, -0.48858475458780326, 5.8500419466977061}},
       0.0218611267},
      {{{2.207715226157033, 1.3031239424803491, -0.027999488188184499},
        {2.3691980769424212, 1.3015338179994862, -0.022753678866611261},
        {1.3404703244603737, -1.387642569804294, 0.2364905859653797, -0.09841316921323584, 0.40930796731699398}},
       0.124003161},
      // the shortest change of velocity and acceleration, as long as the fall of the other end (top) or not (saddle)
      {{{2.9963540679887846, -88.249987150270684, -0.0016792347508964856},
        {0.34550576112523168, -88.249934917556402, -0.0062881173747728093},
        {45.016055495332857, -124.25534913488225, 0.026685484200522934, -0.037324473306309253, 0.79177814677377178}},
       0.0300379602},
      {{{-0.12377927262278687, 32.729179109101992, -0.0010411574418601548},
        {-0.10171153967492917, 32.729178065099525, -0.0015264371950674941},
        {43.187002614682996, -55.58980307330134, 0.012395258119436607, -0.0049158471901421044, 1.8497135698255311}},
       0.000674252574},
  };
  for (const Built& built : cases) {
    // Rounding errors of the target in both directions must not change the result.
    for (const double moved : {0.0, -1e-16, 1e-16, -1e-14, 1e-14, -1e-12, 1e-12}) {
      Task task = built.task;
      task.target.position += moved;
      const Motion motion = planned(task);
      EXPECT_NEAR(motion.duration_s, built.duration_s, 1e-8 * built.duration_s) << moved << text(task);
      expect_flawless(motion, task);
    }
  }
}

TEST(TrajectoryArrival, AnAccelerationWhoseSquareIsLostBesideTheVelocity) {
  // Regression: at the velocity limit such a start missed its own acceleration and drifted during the whole cruise.
  std::mt19937_64 random(28);
  for (int i = 0; i < problem_count(); ++i) {
    Task task = random_task(random);
    task.start.velocity = task.limits.velocity_max;
    task.start.acceleration = std::pow(10.0, uniform(random, -12, -7));
    if (i % 2 == 0) {
      task.start.velocity = task.limits.velocity_min;
      task.start.acceleration = -task.start.acceleration;
    }
    expect_flawless(planned(task), task);
  }
}

/// Returns the state to which the last segment leads.
State end_of(const Motion& motion) {
  if (motion.segment_count == 0) {
    return motion.target;
  }
  const TrajectorySegment<double>& last = motion.segments[motion.segment_count - 1];
  return Motion::advanced(last.start, last.jerk, last.duration_s);
}

/// Checks the accuracy of the end that plan_position guarantees.
void expect_arrival(const Motion& motion, const Task& task) {
  const Limits& l = task.limits;
  const double velocity = std::max(l.velocity_max, -l.velocity_min);
  const double acceleration = std::max(l.acceleration_max, -l.acceleration_min);
  const double reach = std::max(std::abs(task.start.position), std::abs(task.target.position)) + velocity * velocity / acceleration;
  const State end = end_of(motion);
  EXPECT_LE(std::abs(end.position - task.target.position), 1e-8 * reach) << text(task);
  EXPECT_LE(std::abs(end.velocity - task.target.velocity), 1e-8 * velocity) << text(task);
  EXPECT_LE(std::abs(end.acceleration - task.target.acceleration), 1e-8 * acceleration) << text(task);
}

TEST(TrajectoryArrival, AWayThatLeadsFarOutEndsAtTheTarget) {
  // Limits a million times apart: starts that must go out to 1e17 m return exactly to their target, not metres beside it.
  std::mt19937_64 random(29);
  double worst = 0.0;
  int asked = 0;
  for (int i = 0; i < problem_count(); ++i) {
    Task task;
    const Limits l = task.limits = limits_within(random, 1000);
    const double bound = 0.9;
    task.start = {uniform(random, -10, 10), uniform(random, -l.velocity_max, l.velocity_max),
                  uniform(random, -l.acceleration_max, l.acceleration_max)};
    task.target = {uniform(random, -10, 10), bound * uniform(random, l.velocity_min, l.velocity_max),
                   bound * uniform(random, l.acceleration_min, l.acceleration_max)};
    Motion motion;
    const PlanResult result = plan_position(task.start, task.target, task.limits, motion);
    if (result == PlanResult::target_without_approach) {
      continue;
    }
    ASSERT_EQ(result, PlanResult::ok) << text(task);
    ++asked;
    expect_arrival(motion, task);
    worst = std::max(worst, std::abs(end_of(motion).position - task.target.position));
    // The rounding errors of the path must appear where it is farthest, and be small compared with that.
    const double infinity = std::numeric_limits<double>::infinity();
    double farthest = scale_of(task, motion.duration_s).position;
    for (int k = 0; k < motion.segment_count; ++k) {
      farthest = std::max(farthest, std::abs(motion.segments[k].start.position));
    }
    for (int k = 0; k + 1 < motion.segment_count; ++k) {
      const TrajectorySegment<double>& s = motion.segments[k];
      const double jump = Motion::advanced(s.start, s.jerk, s.duration_s).position - motion.segments[k + 1].start.position;
      EXPECT_LE(std::abs(jump), 1e-8 * farthest) << text(task);
    }
    EXPECT_LT(farthest, infinity);
  }
  EXPECT_LE(worst, 1e-8);  // in m, although many paths go out to 1e9 m and more
  EXPECT_GT(asked, problem_count() / 3);
}

TEST(TrajectoryArrival, OkIsNeverSaidOfAMissedTarget) {
  std::mt19937_64 random(30);
  int out_of_range = 0;
  const auto any = [&] { return (random() % 2 == 0 ? -1 : 1) * std::pow(10.0, uniform(random, -30, 30)); };
  for (int i = 0; i < problem_count(); ++i) {
    Task task{{any(), any(), any()}, {any(), 0.0, 0.0}, {}};
    task.limits = {std::abs(any()), -std::abs(any()), std::abs(any()), -std::abs(any()), std::abs(any())};
    Motion motion;
    const PlanResult result = plan_position(task.start, task.target, task.limits, motion);
    ASSERT_TRUE(result == PlanResult::ok || result == PlanResult::out_of_range) << text(task);
    out_of_range += result == PlanResult::out_of_range ? 1 : 0;
    if (result == PlanResult::ok) {
      expect_arrival(motion, task);
    } else {
      EXPECT_EQ(motion.segment_count, 0);
    }
    if (plan_bang_bang(task.start, task.target, task.limits, motion) == PlanResult::ok) {
      const double velocity = std::max(task.limits.velocity_max, -task.limits.velocity_min);
      EXPECT_LE(std::abs(end_of(motion).velocity - task.target.velocity), 1e-8 * velocity) << text(task);
    }
  }
  EXPECT_GT(out_of_range, 0);
}

TEST(TrajectoryArrival, BesideALargeVelocityTheAccelerationKeepsItsLimit) {
  // Regression: with the velocity at its limit at both ends, a motion of 443 times the acceleration was taken for a rounding error.
  const Task task{{0.00041953722389421273, -1824.3890266849216, 0.00013140995237322025},
                  {-0.00027132456965280044, -1824.3890266849216, 0.00023670276998448073},
                  {23042.620128732324, -1824.3890266849216, 0.00026622071430543257, -6.9526299006441692e-06, 623974.53998763638}};
  Motion motion;
  if (plan_position(task.start, task.target, task.limits, motion) == PlanResult::ok) {
    for (int i = 0; i < motion.segment_count; ++i) {
      EXPECT_LE(std::abs(motion.segments[i].start.acceleration), task.limits.acceleration_max * (1 + 1e-10));
    }
    expect_arrival(motion, task);
  }
}

TEST(TrajectoryArrival, WithinTwelveDecadesOkKeepsTheLimitsAndFewAreOutOfRange) {
  // Velocity, acceleration and jerk vary from 1e-6 to 1e6 each. If a hold at a tiny acceleration follows a million times steeper slope, its
  // duration is a difference of velocities beyond double precision. A few in 10^5 then miss their target by more than the tolerance.
  std::mt19937_64 random(31);
  constexpr double kSpan = 1e6;
  int out_of_range = 0;
  int asked = 0;
  for (int i = 0; i < problem_count(); ++i) {
    Task task;
    const Limits l = task.limits = {scale_within(random, kSpan), -scale_within(random, kSpan), scale_within(random, kSpan),
                                    -scale_within(random, kSpan), scale_within(random, kSpan)};
    const auto any = [&](double direction) {
      State s{uniform(random, -10, 10), uniform(random, l.velocity_min, l.velocity_max), 0.0};
      const double up = std::sqrt(2 * l.jerk_max * (l.velocity_max - s.velocity));
      const double down = std::sqrt(2 * l.jerk_max * (s.velocity - l.velocity_min));
      s.acceleration = uniform(random, std::max(l.acceleration_min, direction > 0 ? -down : -up),
                               std::min(l.acceleration_max, direction > 0 ? up : down));
      return s;
    };
    task.start = any(1.0);
    task.target = any(-1.0);
    Motion motion;
    const PlanResult result = plan_position(task.start, task.target, task.limits, motion);
    ++asked;
    if (result == PlanResult::out_of_range) {
      ++out_of_range;
      continue;
    }
    ASSERT_EQ(result, PlanResult::ok) << text(task);
    expect_arrival(motion, task);
    const double velocity_room = 2e-10 * std::max(l.velocity_max, -l.velocity_min);
    const double acceleration_room = 2e-10 * std::max(l.acceleration_max, -l.acceleration_min);
    for (int k = 0; k < motion.segment_count; ++k) {
      const State& s = motion.segments[k].start;
      ASSERT_LE(s.velocity, l.velocity_max + velocity_room) << text(task);
      ASSERT_GE(s.velocity, l.velocity_min - velocity_room) << text(task);
      ASSERT_LE(s.acceleration, l.acceleration_max + acceleration_room) << text(task);
      ASSERT_GE(s.acceleration, l.acceleration_min - acceleration_room) << text(task);
    }
  }
  EXPECT_LE(out_of_range, 5 + asked / 5000);
}

}  // namespace
}  // namespace robot_core::reference
