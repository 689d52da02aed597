// Time-optimal motion of one or several axes under limits of velocity, acceleration and jerk.
//
// Every function is pure: no clock, no heap, no globals, bounded time. Real is float (controller) or double (host). An axis is a
// length in m or an angle in rad. Velocity, acceleration and jerk are its derivatives per s, s2 and s3; times and durations are in
// s.
#pragma once

#include "robot_core/math.h"

namespace robot_core {

template <typename Real>
struct AxisState {
  Real position = 0;      ///< m or rad
  Real velocity = 0;      ///< m/s or rad/s
  Real acceleration = 0;  ///< m/s2 or rad/s2
};

/// Limits of one axis. All must be finite, the maxima above zero and the minima below zero. The jerk stays between -jerk_max and +jerk_max.
template <typename Real>
struct AxisLimits {
  Real velocity_max = 0;
  Real velocity_min = 0;
  Real acceleration_max = 0;
  Real acceleration_min = 0;
  Real jerk_max = 0;

  /// Returns the same limits for both directions.
  static constexpr AxisLimits symmetric(Real velocity, Real acceleration, Real jerk) {
    return {velocity, -velocity, acceleration, -acceleration, jerk};
  }
};

/// Result of a planner: `ok`, or the reason why there is no trajectory. The numbers are stable because telemetry contains them.
enum class PlanResult : unsigned char {
  ok = 0,
  /// A state, target or limit is NaN or infinite.
  not_finite = 1,
  /// A maximum is not above zero, or a minimum is not below zero.
  limit_without_room = 2,
  /// The target's velocity lies outside the limits (for a moving target: on or outside them).
  target_velocity_beyond_limit = 3,
  /// The target's acceleration lies outside the limits.
  target_acceleration_beyond_limit = 4,
  /// Every motion that reaches the target's velocity and acceleration breaks a velocity limit before.
  target_without_approach = 5,
  /// The numbers are so far apart that Real cannot hold the durations or distances. The last segment would miss the target, or a plan in
  /// the plane would leave the circle.
  out_of_range = 6,
  /// There is no axis, or more than kMostAxes.
  not_that_many_axes = 7,
};

/// Segment of constant jerk with the state at its start.
template <typename Real>
struct TrajectorySegment {  // NOLINT(cppcoreguidelines-pro-type-member-init): of those in a Trajectory most hold no values
  Real start_s;
  Real duration_s;
  Real jerk;  ///< m/s3 or rad/s3
  AxisState<Real> start;
};

/// Planned motion. Only the first `segment_count` segments hold values.
template <typename Real>
struct Trajectory {
  /// A lead in the plane takes at most five segments, leaving a violated limit two, the widest motion of a given duration thirteen.
  static constexpr int kMostSegments = 20;

  int segment_count = 0;
  Real duration_s = 0;
  AxisState<Real> target{};  ///< target state at duration_s
  TrajectorySegment<Real> segments[kMostSegments];

  /// Returns the state at `time_s`. Before 0 that is the start; after the duration the target continues with its acceleration.
  AxisState<Real> at(Real time_s) const {
    if (segment_count == 0 || time_s >= duration_s) {
      return advanced(target, Real(0), larger(time_s - duration_s, Real(0)));
    }
    const TrajectorySegment<Real>& segment = segments[segment_at(time_s)];
    return advanced(segment.start, segment.jerk, clamped(time_s - segment.start_s, Real(0), segment.duration_s));
  }

  /// Returns the jerk at `time_s`; 0 outside the motion.
  Real jerk_at(Real time_s) const {
    return segment_count == 0 || !(time_s >= Real(0)) || time_s >= duration_s ? Real(0) : segments[segment_at(time_s)].jerk;
  }

  /// Returns the index of the segment at `time_s`.
  int segment_at(Real time_s) const {
    int i = segment_count - 1;
    while (i > 0 && time_s < segments[i].start_s) {
      --i;
    }
    return i;
  }

  /// Returns the state after `time_s` of constant jerk.
  static AxisState<Real> advanced(const AxisState<Real>& from, Real jerk, Real time_s) {
    return {from.position + time_s * (from.velocity + time_s * (from.acceleration / Real(2) + time_s * (jerk / Real(6)))),
            from.velocity + time_s * (from.acceleration + time_s * (jerk / Real(2))), from.acceleration + time_s * jerk};
  }
};

/// Condition at which the motion meets its target.
enum class Target : unsigned char {
  /// The motion ends at the given position with the given velocity and acceleration.
  at_position,
  /// The target keeps its velocity from now on (its acceleration counts as 0). The motion ends at the position that it has by then.
  moving_on,
};

/// Plans the fastest motion of one axis. A start outside the limits is first led back inside along the shortest path. The accuracy
/// is stated in docs/planners.md; out_of_range if rounding errors exceed it.
template <typename Real>
PlanResult plan_position(const AxisState<Real>& start, const AxisState<Real>& target, const AxisLimits<Real>& limits,
                         Trajectory<Real>& trajectory, Target how = Target::at_position);

/// Plans the fastest change to the target's velocity and acceleration. Positions and velocity limits are ignored, but all values of
/// `limits` must be valid.
template <typename Real>
PlanResult plan_velocity(const AxisState<Real>& start, const AxisState<Real>& target, const AxisLimits<Real>& limits,
                         Trajectory<Real>& trajectory);

/// For comparison: plans the fastest motion with jumps of the acceleration. Ignores jerk_max and the accelerations of all states.
template <typename Real>
PlanResult plan_bang_bang(const AxisState<Real>& start, const AxisState<Real>& target, const AxisLimits<Real>& limits,
                          Trajectory<Real>& trajectory, Target how = Target::at_position);

inline constexpr int kMostAxes = 6;
/// Plans several axes that arrive together as early as possible, at most kMostAxes. The slowest axis moves as plan_position() plans it. If
/// the result is not ok, `failed_axis` (may be null) is set to the axis concerned, except for not_that_many_axes. Targets at rest and
/// Target::moving_on can be planned anew at every tick; a plan to a velocity at a fixed position must be followed to its end.
template <typename Real>
PlanResult plan_synchronised(int axis_count, const AxisState<Real>* start, const AxisState<Real>* target, const AxisLimits<Real>* limits,
                             Trajectory<Real>* trajectories, Target how = Target::at_position, int* failed_axis = nullptr);

/// Plans several axes that reach the velocities and accelerations of their targets together as early as possible; positions are ignored.
/// With symmetric limits and no acceleration at both ends, each axis keeps the shape of its fastest change. Axes with equal limits then go
/// straight from one velocity to the other.
template <typename Real>
PlanResult plan_velocity_synchronised(int axis_count, const AxisState<Real>* start, const AxisState<Real>* target,
                                      const AxisLimits<Real>* limits, Trajectory<Real>* trajectories, int* failed_axis = nullptr);

/// Limits of the motion in the plane, for the lengths of the vectors, so that they hold in every direction.
template <typename Real>
struct PlaneLimits {
  Real speed_max = 0;         ///< m/s
  Real acceleration_max = 0;  ///< m/s2
  Real jerk_max = 0;          ///< m/s3
};

/// Plans x, y and yaw of a robot (axes 0, 1 and 2) so that they arrive together. Speed, acceleration and jerk in the plane stay inside
/// their circles to 0.2 % if the start does, also if the motion is planned anew in every tick. docs/planners.md states for which starts
/// this holds and what bounds the others. A target may use all but 1e-6 (float: 1e-4) of a limit; else the result names the limit that has
/// no room for it. A target whose own acceleration leads out of the circle is followed out of it. The result is out_of_range if every plan
/// leads out.
template <typename Real>
PlanResult plan_plane(const AxisState<Real> (&start)[3], const AxisState<Real> (&target)[3], const PlaneLimits<Real>& plane,
                      const AxisLimits<Real>& yaw, Trajectory<Real> (&trajectories)[3], Target how = Target::at_position);

/// Plans x, y and yaw so that they reach the velocities of their targets together, for example a standstill. x and y share acceleration and
/// jerk as in plan_plane(); positions and speed limits are ignored.
template <typename Real>
PlanResult plan_plane_velocity(const AxisState<Real> (&start)[3], const AxisState<Real> (&target)[3], const PlaneLimits<Real>& plane,
                               const AxisLimits<Real>& yaw, Trajectory<Real> (&trajectories)[3]);

/// For comparison: plan_bang_bang() in the plane. x and y share the circle so that both are equally slow; yaw is planned on its own.
template <typename Real>
PlanResult plan_plane_bang_bang(const AxisState<Real> (&start)[3], const AxisState<Real> (&target)[3], const PlaneLimits<Real>& plane,
                                const AxisLimits<Real>& yaw, Trajectory<Real> (&trajectories)[3], Target how = Target::at_position);

}  // namespace robot_core
