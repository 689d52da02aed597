#include <limits>

#include "robot_core/trajectory.h"
#include "robot_core/trajectory_arrival.h"
#include "robot_core/trajectory_limits.h"

namespace robot_core {
namespace detail {
namespace {

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
  void balance(const Duration& duration_s) {
    constexpr int kHalvings = std::numeric_limits<Real>::digits > 32 ? 24 : 16;
    for (int i = 0; i < kHalvings; ++i) {
      const Real middle = (low_ + high_) / Real(2);
      (duration_s(limits_at(middle, 0), 0) > duration_s(limits_at(middle, 1), 1) ? high_ : low_) = middle;
    }
  }

  [[nodiscard]] AxisLimits<Real> limits(int axis) const { return limits_at((low_ + high_) / Real(2), axis); }

 private:
  [[nodiscard]] AxisLimits<Real> limits_at(Real t, int axis) const {
    const Real share = (axis == 0 ? Real(1) - t * t : Real(2) * t) / (Real(1) + t * t);
    return AxisLimits<Real>::symmetric(share * plane_.speed_max, share * plane_.acceleration_max, share * plane_.jerk_max);
  }

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
  split.balance([&](const AxisLimits<Real>& limits, int axis) { return earliest_arrival_s(start[axis], target[axis], limits, how); });
  const AxisLimits<Real> limits[3] = {split.limits(0), split.limits(1), yaw};
  return plan_synchronised(3, start, target, limits, trajectories, how);
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
  split.balance([&](const AxisLimits<Real>& limits, int axis) {
    return plan_velocity(start[axis], target[axis], limits, trajectories[axis]) == PlanResult::ok ? trajectories[axis].duration_s
                                                                                                  : std::numeric_limits<Real>::max();
  });
  const AxisLimits<Real> limits[3] = {split.limits(0), split.limits(1), yaw};
  return plan_velocity_synchronised(3, start, target, limits, trajectories);
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
  split.balance([&](const AxisLimits<Real>& limits, int axis) {
    return plan_bang_bang(start[axis], target[axis], limits, trajectories[axis], how) == PlanResult::ok ? trajectories[axis].duration_s
                                                                                                        : std::numeric_limits<Real>::max();
  });
  PlanResult result = PlanResult::ok;
  for (int axis = 0; axis < 3 && result == PlanResult::ok; ++axis) {
    result = plan_bang_bang(start[axis], target[axis], axis < 2 ? split.limits(axis) : yaw, trajectories[axis], how);
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
