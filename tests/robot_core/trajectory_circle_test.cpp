// Circle that bounds speed and acceleration of a robot, from any start and with a new plan in every tick.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "robot_core/trajectory.h"
#include "trajectory_expectations.h"
#include "trajectory_reference.h"

namespace robot_core::reference {
namespace {

const Limits kYaw = Limits::symmetric(20, 50, 500);
/// Ratio that trajectory.h guarantees.
constexpr double kMost = 1.002;

template <typename Real>
double speed(const AxisState<Real>& x, const AxisState<Real>& y) {
  return std::hypot(static_cast<double>(x.velocity), static_cast<double>(y.velocity));
}

template <typename Real>
double acceleration(const AxisState<Real>& x, const AxisState<Real>& y) {
  return std::hypot(static_cast<double>(x.acceleration), static_cast<double>(y.acceleration));
}

/// Returns the speed after the shortest segment of full jerk that brings the acceleration to zero.
double braked_speed(const State& x, const State& y, double jerk) {
  const double time_s = acceleration(x, y) / jerk;
  return std::hypot(x.velocity + x.acceleration * time_s / 2, y.velocity + y.acceleration * time_s / 2);
}

PlaneLimits<double> any_plane(std::mt19937_64& random) {
  return {std::exp(uniform(random, -1.5, 1.5)), std::exp(uniform(random, -1.0, 2.5)), std::exp(uniform(random, 0.0, 4.0))};
}

/// Largest speed and acceleration of a path.
struct Longest {
  double speed = 0.0;
  double acceleration = 0.0;
  double jerk = 0.0;
};

template <typename Real>
Longest longest(const Trajectory<Real> (&motions)[3]) {
  constexpr int kSamples = 400;
  Longest most;
  const auto look = [&](Real time_s) {
    const AxisState<Real> x = motions[0].at(time_s);
    const AxisState<Real> y = motions[1].at(time_s);
    most.speed = std::max(most.speed, speed(x, y));
    most.acceleration = std::max(most.acceleration, acceleration(x, y));
    most.jerk =
        std::max(most.jerk, std::hypot(static_cast<double>(motions[0].jerk_at(time_s)), static_cast<double>(motions[1].jerk_at(time_s))));
  };
  for (int i = 0; i <= kSamples; ++i) {
    look(motions[0].duration_s * static_cast<Real>(i) / static_cast<Real>(kSamples));
  }
  // In the frame of a target that is hardly slower than the limit, all turns are short.
  for (int axis = 0; axis < 2; ++axis) {
    for (int i = 0; i < motions[axis].segment_count; ++i) {
      look(motions[axis].segments[i].start_s);
    }
  }
  return most;
}

TEST(TrajectoryCircle, AStartThatOnceLeftItByAFifth) {
  const PlaneLimits<double> plane{1.1057977599240298, 8.853838354213309, 16.102100106184182};
  const State start[3] = {
      {-1.2580836842440206, 0.29683951612951215, 3.1930057760200912}, {2.8043758038566953, 0.95399696139060997, -5.726387177471131}, {}};
  const State target[3] = {{1.3172692007111628, 0, 0}, {-3.7463480857234724, 0, 0}, {}};
  Motion motions[3];
  ASSERT_EQ(plan_plane(start, target, plane, kYaw, motions), PlanResult::ok);
  const Longest most = longest(motions);
  EXPECT_LE(most.speed, kMost * plane.speed_max);
  EXPECT_LE(most.acceleration, kMost * plane.acceleration_max);
}

TEST(TrajectoryCircle, AnyStartThatCanStayInsideDoes) {
  std::mt19937_64 random(31);
  int can_stay = 0;
  for (int i = 0; i < problem_count(); ++i) {
    const PlaneLimits<double> plane = i % 2 == 0 ? any_plane(random) : PlaneLimits<double>{2, 2, 6};
    const auto part = [&](double of) { return uniform(random, -of, of); };
    const State start[3] = {{part(6), part(plane.speed_max), part(plane.acceleration_max)},
                            {part(4), part(plane.speed_max), part(plane.acceleration_max)},
                            {part(3), part(4), 0}};
    State target[3] = {{part(6), 0, 0}, {part(4), 0, 0}, {}};
    if (i % 3 == 0) {
      target[0].velocity = part(0.6 * plane.speed_max);
      target[1].velocity = part(0.6 * plane.speed_max);
    }
    Motion motions[3];
    ASSERT_EQ(plan_plane(start, target, plane, kYaw, motions, i % 3 == 0 ? Target::moving_on : Target::at_position), PlanResult::ok);
    const Longest most = longest(motions);
    // Braking the acceleration along its own direction is one way to stay inside. Other starts go no further out than that way leads.
    const double braked = braked_speed(start[0], start[1], plane.jerk_max);
    ASSERT_LE(most.speed, kMost * std::max({plane.speed_max, speed(start[0], start[1]), braked})) << i;
    ASSERT_LE(most.acceleration, kMost * std::max(plane.acceleration_max, acceleration(start[0], start[1]))) << i;
    ASSERT_LE(most.jerk, plane.jerk_max * (1 + 1e-9)) << i;
    can_stay += braked <= plane.speed_max && speed(start[0], start[1]) <= plane.speed_max ? 1 : 0;
    for (int axis = 0; axis < 3; ++axis) {
      const Limits wide = Limits::symmetric(100, 100, axis < 2 ? plane.jerk_max : kYaw.jerk_max);
      const Flaws flaws = flaws_of(motions[axis], {start[axis], motions[axis].target, wide});
      EXPECT_LE(std::max({flaws.end, flaws.gap, flaws.jerk}), 1e-9);
    }
    ASSERT_FALSE(HasFailure()) << i;
  }
  EXPECT_GT(can_stay, problem_count() / 2);
}

/// Halves the speed limit of robots in motion, as a referee does. Returns how many of them then have a plan.
template <typename Real>
int planned_under_half_the_limit(int count) {
  std::mt19937_64 random(35);
  const auto real = [](double value) { return static_cast<Real>(value); };
  const AxisLimits<Real> yaw = AxisLimits<Real>::symmetric(20, 50, 500);
  int planned = 0;
  for (int i = 0; i < count; ++i) {
    PlaneLimits<Real> plane{3, 4, 25};
    AxisState<Real> state[3] = {};
    const AxisState<Real> target[3] = {{real(uniform(random, -6, 6)), 0, 0}, {real(uniform(random, -4, 4)), 0, 0}, {}};
    Trajectory<Real> motions[3];
    EXPECT_EQ(plan_plane(state, target, plane, yaw, motions), PlanResult::ok);
    const Real time_s = motions[0].duration_s * real(uniform(random, 0, 1));
    for (int axis = 0; axis < 3; ++axis) {
      state[axis] = motions[axis].at(time_s);
    }
    plane.speed_max /= 2;
    planned += plan_plane(state, target, plane, yaw, motions) == PlanResult::ok ? 1 : 0;
  }
  return planned;
}

TEST(TrajectoryCircle, ALimitThatFallsOnTheWayLeavesAPlan) {
  EXPECT_EQ(planned_under_half_the_limit<double>(problem_count()), problem_count());
  EXPECT_EQ(planned_under_half_the_limit<float>(problem_count()), problem_count());
}

/// Returns the time to reach a moving target, planned in double precision.
template <typename Real>
double chase_s(const AxisState<Real> (&start)[3], const AxisState<Real> (&target)[3], const PlaneLimits<Real>& plane) {
  const State from[3] = {widened(start[0]), widened(start[1]), widened(start[2])};
  const State to[3] = {widened(target[0]), widened(target[1]), widened(target[2])};
  Motion motions[3];
  EXPECT_EQ(plan_plane(from, to, {plane.speed_max, plane.acceleration_max, plane.jerk_max}, kYaw, motions, Target::moving_on),
            PlanResult::ok);
  return motions[0].duration_s;
}

/// Targets move with `part` of the speed limit. Returns how many are met or out of range; no plan may leave the circle.
template <typename Real>
int met_inside(double part, int count, bool any_limits) {
  std::mt19937_64 random(34);
  const auto real = [](double value) { return static_cast<Real>(value); };
  const AxisLimits<Real> yaw = AxisLimits<Real>::symmetric(20, 50, 500);
  int met = 0;
  for (int i = 0; i < count; ++i) {
    const PlaneLimits<double> like = any_limits ? any_plane(random) : PlaneLimits<double>{2.5, 3, 12};
    const PlaneLimits<Real> plane{real(like.speed_max), real(like.acceleration_max), real(like.jerk_max)};
    const double v = 0.68 * like.speed_max;
    AxisState<Real> start[3];
    AxisState<Real> target[3];
    for (int axis = 0; axis < 2; ++axis) {
      start[axis] = {real(uniform(random, -2, 2)), real(uniform(random, -v, v)), 0};
      target[axis].position = real(uniform(random, -2, 2));
    }
    // Every fourth target moves along an axis or a diagonal, where the room is smallest.
    const double angle = i % 4 == 0 ? std::round(uniform(random, 0, 8)) * M_PI / 4 : uniform(random, 0, 2 * M_PI);
    target[0].velocity = real(part * like.speed_max * std::cos(angle));
    target[1].velocity = real(part * like.speed_max * std::sin(angle));
    Trajectory<Real> motions[3];
    if (const PlanResult result = plan_plane(start, target, plane, yaw, motions, Target::moving_on); result != PlanResult::ok) {
      // A chase of minutes with the small rest of the limits exceeds the range of float.
      met += any_limits && result == PlanResult::out_of_range && chase_s(start, target, plane) > 120 ? 1 : 0;
      continue;
    }
    ++met;
    const Longest most = longest(motions);
    EXPECT_LE(most.speed, kMost * like.speed_max) << i;
    EXPECT_LE(most.acceleration, kMost * like.acceleration_max) << i;
  }
  return met;
}

TEST(TrajectoryCircle, ATargetMayBeNearlyAsFastAsTheLimit) {
  const int count = problem_count() / 5;
  for (const double part : {0.5, 0.9, 0.97, 0.99, 0.999, 0.9999}) {
    EXPECT_EQ(met_inside<float>(part, count, false), count) << part;
    EXPECT_EQ(met_inside<double>(part, count, false), count) << part;
  }
  EXPECT_EQ(met_inside<double>(1 - 1e-6, count, false), count);
  EXPECT_EQ(met_inside<float>(0.99, count, true), count);
  // Closer to the limit than float resolves, a plan may be missing, but none may leave the circle.
  for (const double part : {0.99999, 0.999999}) {
    EXPECT_GE(met_inside<float>(part, count, false), count * 9 / 10) << part;
  }
}

TEST(TrajectoryCircle, ALongWayBehindALeadInSinglePrecision) {
  const AxisState<float> start[3] = {{}, {0, -1.666F, 0}, {}};
  const AxisState<float> target[3] = {{1, 2.475F, 0}, {0.5F, 0, 0}, {}};
  Trajectory<float> motions[3];
  ASSERT_EQ(plan_plane(start, target, {2.5F, 3, 12}, AxisLimits<float>::symmetric(10, 30, 200), motions, Target::moving_on),
            PlanResult::ok);
  const Longest most = longest(motions);
  EXPECT_LE(most.speed, kMost * 2.5);
  EXPECT_LE(most.acceleration, kMost * 3);
  for (int axis = 0; axis < 2; ++axis) {
    const Trajectory<float>& motion = motions[axis];
    const TrajectorySegment<float>& last = motion.segments[motion.segment_count - 1];
    const AxisState<float> end = Trajectory<float>::advanced(last.start, last.jerk, last.duration_s);
    EXPECT_NEAR(end.position, target[axis].position + target[axis].velocity * motion.duration_s, 2e-2F);
    EXPECT_NEAR(end.velocity, target[axis].velocity, 1e-4F);
  }
}

/// Robot that plans anew in every tick, or only at every jump of its target.
template <typename Real>
class Robot {
 public:
  Robot(const PlaneLimits<double>& plane, double x, double y)
      : plane_{static_cast<Real>(plane.speed_max), static_cast<Real>(plane.acceleration_max), static_cast<Real>(plane.jerk_max)},
        state_{{static_cast<Real>(x), 0, 0}, {static_cast<Real>(y), 0, 0}, {}} {}

  void plan(const State& x, const State& y, Target how) {
    const auto narrowed = [](const State& s) {
      return AxisState<Real>{static_cast<Real>(s.position), static_cast<Real>(s.velocity), static_cast<Real>(s.acceleration)};
    };
    const AxisState<Real> target[3] = {narrowed(x), narrowed(y), {}};
    ASSERT_EQ(plan_plane(state_, target, plane_, AxisLimits<Real>::symmetric(20, 50, 500), motions_, how), PlanResult::ok);
    passed_s_ = 0;
  }

  void advance(double period_s) {
    constexpr int kSamples = 5;
    for (int i = 1; i <= kSamples; ++i) {
      const Real time_s = passed_s_ + static_cast<Real>(period_s) * static_cast<Real>(i) / static_cast<Real>(kSamples);
      for (int axis = 0; axis < 3; ++axis) {
        state_[axis] = motions_[axis].at(time_s);
      }
      speed_ = std::max(speed_, speed(state_[0], state_[1]) / static_cast<double>(plane_.speed_max));
      acceleration_ = std::max(acceleration_, acceleration(state_[0], state_[1]) / static_cast<double>(plane_.acceleration_max));
    }
    passed_s_ += static_cast<Real>(period_s);
  }

  /// Largest speed so far over its limit.
  [[nodiscard]] double most_speed() const { return speed_; }
  [[nodiscard]] double most_acceleration() const { return acceleration_; }
  [[nodiscard]] double distance(double x, double y) const {
    return std::hypot(static_cast<double>(state_[0].position) - x, static_cast<double>(state_[1].position) - y);
  }

 private:
  PlaneLimits<Real> plane_;
  AxisState<Real> state_[3];
  Trajectory<Real> motions_[3];
  Real passed_s_ = 0;
  double speed_ = 0.0;
  double acceleration_ = 0.0;
};

constexpr double kTick_s = 1.0 / 60;

template <typename Real>
void follow_jumps(std::mt19937_64& random, const PlaneLimits<double>& plane, bool in_every_tick) {
  constexpr int kTicks = 600;
  constexpr int kJump = 48;
  Robot<Real> robot(plane, uniform(random, -4, 4), uniform(random, -3, 3));
  State x;
  State y;
  for (int tick = 0; tick < kTicks; ++tick) {
    if (tick % kJump == 0) {
      x.position = uniform(random, -4, 4);
      y.position = uniform(random, -3, 3);
    }
    if (in_every_tick || tick % kJump == 0) {
      ASSERT_NO_FATAL_FAILURE(robot.plan(x, y, Target::at_position));
    }
    robot.advance(kTick_s);
  }
  EXPECT_LE(robot.most_speed(), kMost) << plane.speed_max << " " << plane.acceleration_max << " " << plane.jerk_max;
  EXPECT_LE(robot.most_acceleration(), kMost) << plane.speed_max << " " << plane.acceleration_max << " " << plane.jerk_max;
  // The robot reaches the target once that rests.
  for (int tick = 0; tick < 40 * kTicks && robot.distance(x.position, y.position) > 1e-3; ++tick) {
    ASSERT_NO_FATAL_FAILURE(robot.plan(x, y, Target::at_position));
    robot.advance(kTick_s);
  }
  EXPECT_LE(robot.distance(x.position, y.position), 1e-3);
}

TEST(TrajectoryCircle, IsKeptWhileTheTargetJumps) {
  std::mt19937_64 random(32);
  for (int run = 0; run < 20 + problem_count() / 1000; ++run) {
    follow_jumps<double>(random, {2, 2, 6}, true);
    follow_jumps<double>(random, {2, 2, 6}, false);
    follow_jumps<double>(random, {3, 3, 20}, true);
    follow_jumps<double>(random, any_plane(random), true);
    follow_jumps<float>(random, any_plane(random), true);
    ASSERT_FALSE(HasFailure()) << run;
  }
}

TEST(TrajectoryCircle, IsKeptWhileTheTargetCircles) {
  std::mt19937_64 random(33);
  constexpr int kTicks = 900;
  for (int run = 0; run < 20 + problem_count() / 1000; ++run) {
    const PlaneLimits<double> plane = any_plane(random);
    const double radius_m = uniform(random, 0.5, 3);
    const double speed_m_per_s = std::min(radius_m * uniform(random, 0.3, 1.5), 0.8 * plane.speed_max);
    Robot<double> robot(plane, uniform(random, -4, 4), uniform(random, -3, 3));
    for (int tick = 0; tick < kTicks; ++tick) {
      const double angle = speed_m_per_s / radius_m * tick * kTick_s;
      const State x{radius_m * std::cos(angle), -speed_m_per_s * std::sin(angle), 0};
      const State y{radius_m * std::sin(angle), speed_m_per_s * std::cos(angle), 0};
      ASSERT_NO_FATAL_FAILURE(robot.plan(x, y, Target::moving_on));
      robot.advance(kTick_s);
    }
    EXPECT_LE(robot.most_speed(), kMost) << run;
    EXPECT_LE(robot.most_acceleration(), kMost) << run;
  }
}

}  // namespace
}  // namespace robot_core::reference
