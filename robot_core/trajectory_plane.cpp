#include <limits>

#include "robot_core/trajectory.h"
#include "robot_core/trajectory_arrival.h"
#include "robot_core/trajectory_limits.h"

namespace robot_core {
namespace detail {
namespace {

template <typename Real>
Real length(Real x, Real y) {
  return square_root(x * x + y * y);
}

/// How x and y share a circle: x gets the cosine, y the sine of an angle that is told by the tangent t of its half;
/// cos = (1 - t^2)/(1 + t^2), sin = 2 t/(1 + t^2), 0 < t < 1.
template <typename Real>
class Split {
 public:
  explicit Split(const PlaneLimits<Real>& plane) : plane_(plane) {}

  /// x and y are parts of their limits. False if no split is left.
  bool leave_room(Real x, Real y) {
    // Half of the angle whose cosine is x, and whose sine is y.
    high_ = smaller(high_, square_root((Real(1) - absolute(x)) / (Real(1) + absolute(x))));
    low_ = larger(low_, absolute(y) / (Real(1) + square_root(Real(1) - y * y)));
    return low_ <= high_;
  }

  /// `duration_s(limits, axis)` of axis 0 and 1: more of everything makes an axis faster, so the two cross once. An axis
  /// that cannot do with its part needs more.
  template <typename Duration>
  [[nodiscard]] Real balanced(const Duration& duration_s) const {
    constexpr int kHalvings = std::numeric_limits<Real>::digits > 32 ? 24 : 16;
    Real low = low_;
    Real high = high_;
    for (int i = 0; i < kHalvings; ++i) {
      const Real middle = (low + high) / Real(2);
      (duration_s(limits(middle, 0), 0) > duration_s(limits(middle, 1), 1) ? high : low) = middle;
    }
    return (low + high) / Real(2);
  }

  /// The split of a vector's own direction, as near as the room allows.
  [[nodiscard]] Real along(Real x, Real y) const { return clamped(absolute(y) / (length(x, y) + absolute(x)), low_, high_); }

  [[nodiscard]] AxisLimits<Real> limits(Real t, int axis) const {
    const Real share = (axis == 0 ? Real(1) - t * t : Real(2) * t) / (Real(1) + t * t);
    return AxisLimits<Real>::symmetric(share * plane_.speed_max, share * plane_.acceleration_max, share * plane_.jerk_max);
  }

 private:
  PlaneLimits<Real> plane_;
  Real low_ = Real(1) / Real(2048);
  Real high_ = Real(1) - Real(1) / Real(2048);
};

template <typename Real>
PlanResult check_plane(const AxisState<Real> (&start)[3], const AxisState<Real> (&target)[3], const PlaneLimits<Real>& plane) {
  if (!is_whole(start[0]) || !is_whole(start[1]) || !is_whole(target[0]) || !is_whole(target[1]) || !is_finite(plane.speed_max) ||
      !is_finite(plane.acceleration_max) || !is_finite(plane.jerk_max)) {
    return PlanResult::not_finite;
  }
  const bool has_room = plane.speed_max > Real(0) && plane.acceleration_max > Real(0) && plane.jerk_max > Real(0);
  return has_room ? PlanResult::ok : PlanResult::limit_without_room;
}

template <typename Real>
bool leave_room_for_velocity(const AxisState<Real> (&target)[3], const PlaneLimits<Real>& plane, Split<Real>& split) {
  const Real x = target[0].velocity / plane.speed_max;
  const Real y = target[1].velocity / plane.speed_max;
  return x * x + y * y <= Real(1) + kLimitTolerance<Real> && split.leave_room(x, y);
}

template <typename Real>
bool leave_room_for_acceleration(const AxisState<Real> (&target)[3], const PlaneLimits<Real>& plane, Split<Real>& split) {
  return split.leave_room(target[0].acceleration / plane.acceleration_max, target[1].acceleration / plane.acceleration_max);
}

/// What the lengths of velocity and acceleration may be.
template <typename Real>
struct Circle {
  Real speed;
  Real acceleration;
};

/// The limits, or, if that is more, what the start has. The tolerance is of the limits, so that whoever plans again and
/// again gains nothing by it.
template <typename Real>
Circle<Real> circle_of(const PlaneLimits<Real>& plane, const AxisState<Real> (&start)[3]) {
  constexpr Real kTolerance = Real(1) + Real(1e-4);
  return {larger(kTolerance * plane.speed_max, length(start[0].velocity, start[1].velocity)),
          larger(kTolerance * plane.acceleration_max, length(start[0].acceleration, start[1].acceleration))};
}

/// The longest vectors on the way: the square of the larger one's part of the circle, sampled.
template <typename Real>
Real square_on_the_way(const Trajectory<Real> (&trajectories)[3], const Circle<Real>& circle) {
  constexpr int kSamples = 6;
  int at[2] = {0, 0};
  const auto end_s = [&](int axis) {
    const Trajectory<Real>& motion = trajectories[axis];
    return at[axis] + 1 < motion.segment_count ? motion.segments[at[axis] + 1].start_s : motion.duration_s;
  };
  const auto state = [&](int axis, Real time_s) {
    const Trajectory<Real>& motion = trajectories[axis];
    if (motion.segment_count == 0) {
      return motion.at(time_s);
    }
    const TrajectorySegment<Real>& segment = motion.segments[at[axis]];
    return Trajectory<Real>::advanced(segment.start, segment.jerk, time_s - segment.start_s);
  };
  Real most = 0;
  for (Real from_s = 0; at[0] < larger(trajectories[0].segment_count, 1) && at[1] < larger(trajectories[1].segment_count, 1);) {
    const Real until_s = smaller(end_s(0), end_s(1));
    for (int i = 0; i < kSamples; ++i) {
      const Real time_s = from_s + (until_s - from_s) * (Real(i) / Real(kSamples));
      const AxisState<Real> x = state(0, time_s);
      const AxisState<Real> y = state(1, time_s);
      most = larger(most, (x.velocity * x.velocity + y.velocity * y.velocity) / (circle.speed * circle.speed));
      most =
          larger(most, (x.acceleration * x.acceleration + y.acceleration * y.acceleration) / (circle.acceleration * circle.acceleration));
    }
    ++at[end_s(0) <= end_s(1) ? 0 : 1];
    from_s = until_s;
  }
  return most;
}

/// Plans with the fastest split. Where that would leave the circle, because x and y of the start do not fit it, the split
/// turns towards the start's own direction, no further than needed, and not where the motion would then hardly get on.
/// `plan(t)` fills the trajectories.
template <typename Real, typename Plan>
PlanResult plan_inside(const Split<Real>& split, Real fastest, const AxisState<Real> (&start)[3], const Circle<Real>& circle,
                       const Trajectory<Real> (&trajectories)[3], const Plan& plan) {
  constexpr Real kInside = Real(1) + Real(8) * std::numeric_limits<Real>::epsilon();
  constexpr int kHalvings = 6;
  if (const PlanResult result = plan(fastest); result != PlanResult::ok) {
    return result;
  }
  Real best = fastest;
  Real last = fastest;
  Real least = square_on_the_way(trajectories, circle);
  constexpr Real kMostDetour = 8;
  const Real longest_s = kMostDetour * trajectories[0].duration_s;
  const auto square_at = [&](Real t) {
    last = t;
    const bool gets_on = plan(t) == PlanResult::ok && trajectories[0].duration_s <= longest_s;
    const Real square = gets_on ? square_on_the_way(trajectories, circle) : std::numeric_limits<Real>::max();
    if (square < least || square <= kInside) {
      least = square;
      best = t;
    }
    return square;
  };
  const Real own[2][2] = {{start[0].velocity, start[1].velocity}, {start[0].acceleration, start[1].acceleration}};
  // The direction of next to nothing is noise.
  constexpr Real kNoise = Real(1) / Real(128);
  const Real limit[2] = {circle.speed, circle.acceleration};
  for (int i = 0; i < 2 && least > kInside; ++i) {
    if (!(length(own[i][0], own[i][1]) > kNoise * limit[i])) {
      continue;
    }
    Real near = fastest;
    Real far = split.along(own[i][0], own[i][1]);
    const Real square_of_far = square_at(far);
    const bool is_too_far = square_of_far == std::numeric_limits<Real>::max();
    const Real enough = is_too_far ? kInside : larger(square_of_far, kInside);
    for (int halving = 0; halving < kHalvings; ++halving) {
      const Real middle = (near + far) / Real(2);
      const Real square = square_at(middle);
      (square <= enough || square == std::numeric_limits<Real>::max() ? far : near) = middle;
    }
  }
  return best == last ? PlanResult::ok : plan(best);
}

}  // namespace
}  // namespace detail

using namespace detail;

template <typename Real>
PlanResult plan_plane(const AxisState<Real> (&start)[3], const AxisState<Real> (&target)[3], const PlaneLimits<Real>& plane,
                      const AxisLimits<Real>& yaw, Trajectory<Real> (&trajectories)[3], Target how) {
  if (const PlanResult result = check_plane(start, target, plane); result != PlanResult::ok) {
    return result;
  }
  Split<Real> split(plane);
  if (!leave_room_for_velocity(target, plane, split)) {
    return PlanResult::target_velocity_beyond_limit;
  }
  if (how == Target::at_position && !leave_room_for_acceleration(target, plane, split)) {
    return PlanResult::target_acceleration_beyond_limit;
  }
  const Real fastest =
      split.balanced([&](const AxisLimits<Real>& limits, int axis) { return earliest_arrival_s(start[axis], target[axis], limits, how); });
  const Circle<Real> circle = circle_of(plane, start);
  return plan_inside(split, fastest, start, circle, trajectories, [&](Real t) {
    const AxisLimits<Real> limits[3] = {split.limits(t, 0), split.limits(t, 1), yaw};
    return plan_synchronised(3, start, target, limits, trajectories, how);
  });
}

template <typename Real>
PlanResult plan_plane_velocity(const AxisState<Real> (&start)[3], const AxisState<Real> (&target)[3], const PlaneLimits<Real>& plane,
                               const AxisLimits<Real>& yaw, Trajectory<Real> (&trajectories)[3]) {
  if (const PlanResult result = check_plane(start, target, plane); result != PlanResult::ok) {
    return result;
  }
  Split<Real> split(plane);
  if (!leave_room_for_acceleration(target, plane, split)) {
    return PlanResult::target_acceleration_beyond_limit;
  }
  const Real fastest = split.balanced([&](const AxisLimits<Real>& limits, int axis) {
    return plan_velocity(start[axis], target[axis], limits, trajectories[axis]) == PlanResult::ok ? trajectories[axis].duration_s
                                                                                                  : std::numeric_limits<Real>::max();
  });
  const Circle<Real> circle{std::numeric_limits<Real>::max(), circle_of(plane, start).acceleration};
  return plan_inside(split, fastest, start, circle, trajectories, [&](Real t) {
    const AxisLimits<Real> limits[3] = {split.limits(t, 0), split.limits(t, 1), yaw};
    return plan_velocity_synchronised(3, start, target, limits, trajectories);
  });
}

template <typename Real>
PlanResult plan_plane_bang_bang(const AxisState<Real> (&start)[3], const AxisState<Real> (&target)[3], const PlaneLimits<Real>& plane,
                                const AxisLimits<Real>& yaw, Trajectory<Real> (&trajectories)[3], Target how) {
  if (const PlanResult result = check_plane(start, target, plane); result != PlanResult::ok) {
    return result;
  }
  Split<Real> split(plane);
  if (!leave_room_for_velocity(target, plane, split)) {
    return PlanResult::target_velocity_beyond_limit;
  }
  const Real fastest = split.balanced([&](const AxisLimits<Real>& limits, int axis) {
    return plan_bang_bang(start[axis], target[axis], limits, trajectories[axis], how) == PlanResult::ok ? trajectories[axis].duration_s
                                                                                                        : std::numeric_limits<Real>::max();
  });
  PlanResult result = PlanResult::ok;
  for (int axis = 0; axis < 3 && result == PlanResult::ok; ++axis) {
    result = plan_bang_bang(start[axis], target[axis], axis < 2 ? split.limits(fastest, axis) : yaw, trajectories[axis], how);
  }
  return result;
}

#define ROBOT_CORE_INSTANTIATE(Real)                                                                                           \
  template PlanResult plan_plane(const AxisState<Real>(&)[3], const AxisState<Real>(&)[3], const PlaneLimits<Real>&,           \
                                 const AxisLimits<Real>&, Trajectory<Real>(&)[3], Target);                                     \
  template PlanResult plan_plane_velocity(const AxisState<Real>(&)[3], const AxisState<Real>(&)[3], const PlaneLimits<Real>&,  \
                                          const AxisLimits<Real>&, Trajectory<Real>(&)[3]);                                    \
  template PlanResult plan_plane_bang_bang(const AxisState<Real>(&)[3], const AxisState<Real>(&)[3], const PlaneLimits<Real>&, \
                                           const AxisLimits<Real>&, Trajectory<Real>(&)[3], Target)

ROBOT_CORE_INSTANTIATE(float);
#ifndef ROBOT_CORE_WITHOUT_DOUBLE
ROBOT_CORE_INSTANTIATE(double);
#endif

}  // namespace robot_core
