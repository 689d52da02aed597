// The lead: a straight motion of x and y together, before each axis follows its own plan. Part of the trajectory planner.
#pragma once

#include <limits>

#include "robot_core/math.h"
#include "robot_core/trajectory.h"
#include "robot_core/trajectory_circle.h"
#include "robot_core/trajectory_path.h"

namespace robot_core::detail {

/// One axis' part of the lead: segments of constant jerk in m/s3 (or rad/s3), and the state at their end.
template <typename Real>
struct Lead {  // NOLINT(cppcoreguidelines-pro-type-member-init): only the first of the path's places hold values
  Path<Real, 5> path;
  Real duration_s = 0;
  AxisState<Real> end{};

  void add(Real for_s, Real jerk) {
    path.add(for_s, jerk);
    duration_s += larger(for_s, Real(0));
  }
};

/// Brake along a line: jerk against the velocity, hold, jerk back until the acceleration is zero.
template <typename Real>
struct StraightBrake {
  Real jerk_s;
  Real hold_s;
  Real back_s;
};

/// Returns the brake that reduces the speed by `change`. `slope` is the deceleration at its start.
template <typename Real>
StraightBrake<Real> straight_brake(Real change, Real slope, const PlaneLimits<Real>& plane) {
  const Real square = plane.jerk_max * change + slope * slope / Real(2);
  const Real deepest = larger(smaller(square_root(square), plane.acceleration_max), slope);
  const Real missing = square - deepest * deepest;
  const Real hold_s = missing > Real(0) ? missing / (plane.jerk_max * deepest) : Real(0);
  return {(deepest - slope) / plane.jerk_max, hold_s, deepest / plane.jerk_max};
}

/// Motion that brings the accelerations of x and y to zero, each with a fraction of the jerk, and the velocity at its end.
template <typename Real>
struct Calming {
  Real share[2];
  Real time_s[2];
  Real velocity[2];
  Real speed;
};

template <typename Real>
Calming<Real> calming(const AxisState<Real>* start, Real jerk_max, Real share_x, Real share_y) {
  Calming<Real> c{{share_x, share_y}, {}, {}, Real(0)};
  for (int axis = 0; axis < 2; ++axis) {
    const Real slope = start[axis].acceleration;
    c.time_s[axis] = slope == Real(0) ? Real(0) : absolute(slope) / (c.share[axis] * jerk_max);
    c.velocity[axis] = start[axis].velocity + slope * c.time_s[axis] / Real(2);
  }
  c.speed = length(c.velocity[0], c.velocity[1]);
  return c;
}

/// Plans the leads of x and y: the acceleration goes to zero, then the velocity down to `speed` along its own direction. If the
/// acceleration already brakes along the velocity, the brake continues from it.
template <typename Real>
void lead_to(Real speed, const AxisState<Real>* start, const Calming<Real>& calm, const PlaneLimits<Real>& plane, Lead<Real>* leads) {
  constexpr Real kStraight = std::numeric_limits<Real>::digits > 32 ? Real(1e-9) : Real(1e-4);
  const AxisState<Real>& x = start[0];
  const AxisState<Real>& y = start[1];
  const bool is_faster = calm.speed > speed;
  const Real against = -(x.velocity * x.acceleration + y.velocity * y.acceleration);
  const bool is_straight = absolute(x.velocity * y.acceleration - y.velocity * x.acceleration) <= kStraight * against;
  const bool goes_on = is_faster && is_straight && calm.velocity[0] * x.velocity + calm.velocity[1] * y.velocity > Real(0);
  const Real braking = goes_on ? length(x.acceleration, y.acceleration) : Real(0);
  const StraightBrake<Real> brake = straight_brake(calm.speed - speed + braking * braking / plane.jerk_max / Real(2), braking, plane);
  const Real calm_s = larger(calm.time_s[0], calm.time_s[1]);
  for (int axis = 0; axis < 2; ++axis) {
    Lead<Real>& lead = leads[axis];
    lead.path.count = 0;
    lead.duration_s = 0;
    if (!goes_on) {
      lead.add(calm.time_s[axis], (start[axis].acceleration > Real(0) ? -calm.share[axis] : calm.share[axis]) * plane.jerk_max);
      lead.add(calm_s - calm.time_s[axis], Real(0));
    }
    Real velocity = calm.velocity[axis];
    if (is_faster) {
      const Real jerk = calm.velocity[axis] / calm.speed * plane.jerk_max;
      lead.add(brake.jerk_s, -jerk);
      lead.add(brake.hold_s, Real(0));
      lead.add(brake.back_s, jerk);
      velocity = calm.velocity[axis] / calm.speed * speed;
    }
    lead.end = start[axis];
    for (int i = 0; i < lead.path.count; ++i) {
      lead.end = Trajectory<Real>::advanced(lead.end, lead.path.jerk[i], lead.path.duration_s[i]);
    }
    lead.end = {lead.end.position, velocity, Real(0)};
  }
}

/// Writes the lead as the first segments. Its end is set exactly: rounding errors may be large beside a small fraction of the circle and
/// would add up over a long path.
template <typename Real>
void lay_out_lead(const Lead<Real>& lead, Trajectory<Real>& trajectory) {
  for (int i = 0; i < lead.path.count; ++i) {
    trajectory.segments[i] = {trajectory.duration_s, lead.path.duration_s[i], lead.path.jerk[i], trajectory.target};
    trajectory.target = Trajectory<Real>::advanced(trajectory.target, lead.path.jerk[i], lead.path.duration_s[i]);
    trajectory.duration_s += lead.path.duration_s[i];
  }
  trajectory.segment_count = lead.path.count;
  trajectory.target = lead.end;
}

/// Plans as plan_synchronised(), but from the end of the leads of the first `lead_count` axes.
template <typename Real>
PlanResult plan_together(int axis_count, const AxisState<Real>* start, const AxisState<Real>* target, const AxisLimits<Real>* limits,
                         const Lead<Real>* leads, int lead_count, Trajectory<Real>* trajectories, Target how, int* failed_axis);

}  // namespace robot_core::detail
