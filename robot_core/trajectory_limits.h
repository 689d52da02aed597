// Checks of the numbers that every planner makes first.
#pragma once

#include <limits>

#include "robot_core/math.h"
#include "robot_core/trajectory.h"

namespace robot_core::detail {

/// Relative error that a calculated start may have. It is more than a few roundings: after a gap of durations that opens at a small slope
/// y, an error of the velocities counts 1/y times.
template <typename Real>
inline constexpr Real kTouch = std::numeric_limits<Real>::digits > 32 ? Real(1e-11) : Real(1e-5);

/// Relative error that the end of the last segment may have; see plan_position.
template <typename Real>
inline constexpr Real kArrival = std::numeric_limits<Real>::digits > 32 ? Real(1e-8) : Real(1e-3);

template <typename Real>
inline constexpr Real kLimitTolerance = Real(4096) * std::numeric_limits<Real>::epsilon();

constexpr bool is_axis_count(int axis_count) { return axis_count > 0 && axis_count <= kMostAxes; }

template <typename Real>
bool is_whole(const AxisState<Real>& state) {
  return is_finite(state.position) && is_finite(state.velocity) && is_finite(state.acceleration);
}

template <typename Real>
PlanResult check_limits(const AxisLimits<Real>& limits) {
  if (!is_finite(limits.velocity_max) || !is_finite(limits.velocity_min) || !is_finite(limits.acceleration_max) ||
      !is_finite(limits.acceleration_min) || !is_finite(limits.jerk_max)) {
    return PlanResult::not_finite;
  }
  const bool has_room = limits.velocity_max > Real(0) && limits.velocity_min < Real(0) && limits.acceleration_max > Real(0) &&
                        limits.acceleration_min < Real(0) && limits.jerk_max > Real(0);
  return has_room ? PlanResult::ok : PlanResult::limit_without_room;
}

template <typename Real>
bool is_beyond(Real value, Real low, Real high) {
  const Real tolerance = kLimitTolerance<Real> * absolute(value);
  return value > high + tolerance || value < low - tolerance;
}

}  // namespace robot_core::detail
