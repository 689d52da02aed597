// Time-optimal motion of one or several axes under limits of velocity, acceleration and jerk.
//
// Every function is pure: no clock, no heap, no globals, bounded time. Real is float (controller) or double (host).
// An axis may be a length in m or an angle in rad: velocity, acceleration and jerk are its derivatives per s, s2, s3,
// times and durations are in s.
#pragma once

#include "robot_core/math.h"

namespace robot_core {

template <typename Real>
struct AxisState {
  Real position = 0;      ///< m or rad
  Real velocity = 0;      ///< m/s or rad/s
  Real acceleration = 0;  ///< m/s2 or rad/s2
};

/// All finite; the maxima above, the minima below zero. The jerk stays between -jerk_max and +jerk_max.
template <typename Real>
struct AxisLimits {
  Real velocity_max = 0;
  Real velocity_min = 0;
  Real acceleration_max = 0;
  Real acceleration_min = 0;
  Real jerk_max = 0;

  /// The same limits in both directions.
  static constexpr AxisLimits symmetric(Real velocity, Real acceleration, Real jerk) {
    return {velocity, -velocity, acceleration, -acceleration, jerk};
  }
};

/// Why there is no trajectory. Numbers are stable: they travel in telemetry.
enum class PlanResult : unsigned char {
  ok = 0,
  /// A state, target or limit is NaN or infinite.
  not_finite = 1,
  /// A maximum is not above zero, or a minimum not below it.
  limit_without_room = 2,
  /// The target's velocity lies outside of the limits (for a moving target: on or outside).
  target_velocity_beyond_limit = 3,
  /// The target's acceleration lies outside of the limits.
  target_acceleration_beyond_limit = 4,
  /// Whoever has the target's velocity and acceleration has broken a velocity limit before.
  target_without_approach = 5,
  /// The numbers are so far apart that Real cannot hold the durations or distances: the last segment would miss the target, or a plan in
  /// the plane would leave the circle.
  out_of_range = 6,
  /// No axis, or more than kMostAxes.
  not_that_many_axes = 7,
};

/// A segment of constant jerk, with the state at its start.
template <typename Real>
struct TrajectorySegment {  // NOLINT(cppcoreguidelines-pro-type-member-init): of those in a Trajectory most hold no values
  Real start_s;
  Real duration_s;
  Real jerk;  ///< m/s3 or rad/s3
  AxisState<Real> start;
};

/// A planned motion. Only the first `segment_count` segments hold values.
template <typename Real>
struct Trajectory {
  /// A lead in the plane takes at most five segments, leaving a violated limit two; the widest motion of a given duration takes thirteen.
  static constexpr int kMostSegments = 20;

  int segment_count = 0;
  Real duration_s = 0;
  AxisState<Real> target{};  ///< at duration_s
  TrajectorySegment<Real> segments[kMostSegments];

  /// The state at `time_s`. Before 0 it is the start; after the duration the target goes on with its acceleration.
  AxisState<Real> at(Real time_s) const {
    if (segment_count == 0 || time_s >= duration_s) {
      return advanced(target, Real(0), larger(time_s - duration_s, Real(0)));
    }
    const TrajectorySegment<Real>& segment = segments[segment_at(time_s)];
    return advanced(segment.start, segment.jerk, clamped(time_s - segment.start_s, Real(0), segment.duration_s));
  }

  /// The jerk at `time_s`, which is 0 outside of the motion.
  Real jerk_at(Real time_s) const {
    return segment_count == 0 || !(time_s >= Real(0)) || time_s >= duration_s ? Real(0) : segments[segment_at(time_s)].jerk;
  }

  /// The segment that `time_s` lies in.
  int segment_at(Real time_s) const {
    int i = segment_count - 1;
    while (i > 0 && time_s < segments[i].start_s) {
      --i;
    }
    return i;
  }

  /// Constant jerk from `from` on.
  static AxisState<Real> advanced(const AxisState<Real>& from, Real jerk, Real time_s) {
    return {from.position + time_s * (from.velocity + time_s * (from.acceleration / Real(2) + time_s * (jerk / Real(6)))),
            from.velocity + time_s * (from.acceleration + time_s * (jerk / Real(2))), from.acceleration + time_s * jerk};
  }
};

/// How a target is met.
enum class Target : unsigned char {
  /// At the given position, with the given velocity and acceleration.
  at_position,
  /// It keeps the given velocity from now on (its acceleration counts as 0), so it is met where it is by then.
  moving_on,
};

/// The fastest motion of one axis. A start that violates limits is led back first, along the shortest way.
/// If the result is ok, the last segment ends at the target but for 1e-8 (float: 1e-3) of the scales: of the limits for velocity and
/// acceleration; for the position, of the larger of start's and target's, plus velocity^2/acceleration of the limits. Mostly it is 1e-15.
/// Where the way leads far beyond those positions, its rounding errors are put where it is farthest: there, segments follow each other
/// to that part of the farthest position plus velocity^2/acceleration. Limits that the start keeps are kept to 1e-10 (float: 4e-3) of the
/// larger one of both directions. Whatever cannot be had so is out_of_range: none of 10^6 problems whose scales are within four decades of
/// each other, in any units; where velocity, acceleration and jerk are apart by up to twelve, 5 of 10^5 to 74 of
/// 10^4 as states and ways are drawn. A target that is missed by a
/// rounding error (1e-11, float 1e-5) of the velocities counts as met.
template <typename Real>
PlanResult plan_position(const AxisState<Real>& start, const AxisState<Real>& target, const AxisLimits<Real>& limits,
                         Trajectory<Real>& trajectory, Target how = Target::at_position);

/// The fastest change to the target's velocity and acceleration, wherever that leads: position and velocity limits
/// play no part, though `limits` has to be whole.
template <typename Real>
PlanResult plan_velocity(const AxisState<Real>& start, const AxisState<Real>& target, const AxisLimits<Real>& limits,
                         Trajectory<Real>& trajectory);

/// For comparison: the fastest motion with jumping acceleration (jerk_max and all accelerations of states play no part).
template <typename Real>
PlanResult plan_bang_bang(const AxisState<Real>& start, const AxisState<Real>& target, const AxisLimits<Real>& limits,
                          Trajectory<Real>& trajectory, Target how = Target::at_position);

/// Several axes that arrive together, as early as that is possible. The slowest moves as plan_position has it; the
/// others use the time: each blends its widest motion of that duration up and down, so that one with symmetric limits
/// and at rest at both ends keeps the shape of its fastest motion. At most kMostAxes axes.
/// Where the target has a velocity at a fixed place, follow a plan to its end: one of a later tick may find that rounding has made the
/// arrival impossible, and come back for it. Targets at rest and Target::moving_on can be planned anew at every tick.
/// `failed_axis`, if given, is set to the axis that a result other than ok is about (not_that_many_axes is about none).
inline constexpr int kMostAxes = 6;
template <typename Real>
PlanResult plan_synchronised(int axis_count, const AxisState<Real>* start, const AxisState<Real>* target, const AxisLimits<Real>* limits,
                             Trajectory<Real>* trajectories, Target how = Target::at_position, int* failed_axis = nullptr);

/// Several axes that reach the velocities and accelerations of their targets together, as early as that is possible,
/// wherever that leads. With symmetric limits and no acceleration at both ends, each keeps the shape of its fastest change:
/// axes with equal limits go straight from one velocity to the other.
template <typename Real>
PlanResult plan_velocity_synchronised(int axis_count, const AxisState<Real>* start, const AxisState<Real>* target,
                                      const AxisLimits<Real>* limits, Trajectory<Real>* trajectories, int* failed_axis = nullptr);

/// Limits of motion in the plane that hold in every direction: of the lengths of the vectors.
template <typename Real>
struct PlaneLimits {
  Real speed_max = 0;         ///< m/s
  Real acceleration_max = 0;  ///< m/s2
  Real jerk_max = 0;          ///< m/s3
};

/// x, y and yaw of a robot, arriving together. A circle bounds speed, acceleration and jerk in the plane: x gets the
/// share cos(split) of each, y the share sin(split), and the split is chosen so that both are equally slow, within what
/// the target needs. A target may have all but 1e-6 (float: 1e-4, in chases of up to two minutes) of a limit; if no split leaves room for
/// its velocity (or, with that, its acceleration), the result says so. Where the start does not fit that split (a turn at full speed), the
/// split turns; where none fits or that takes long, x and y first bring the acceleration to zero along its own direction, then perhaps
/// brake along the velocity's own, and then share the circle. The shortest of these plans that stays inside of the circle to 0.2 % is
/// taken. There is one from every start with |v| <= speed_max, |a| <= acceleration_max and |v + a |a|/(2 jerk_max)| <= speed_max (its
/// acceleration braked along its own direction), from every start whose axes keep the shares of one split, and from every state of such a
/// plan: whoever plans anew in every tick stays inside. Other starts may leave the circle of speed, but no further than the largest of |v|
/// and |v + a |a|/(2 jerk_max)|, and never that of acceleration beyond their own. A target whose own acceleration leads out of the circle
/// is followed out of it. A plan that leads further out than that is none: the result is out_of_range. axes: 0 x, 1 y, 2 yaw.
template <typename Real>
PlanResult plan_plane(const AxisState<Real> (&start)[3], const AxisState<Real> (&target)[3], const PlaneLimits<Real>& plane,
                      const AxisLimits<Real>& yaw, Trajectory<Real> (&trajectories)[3], Target how = Target::at_position);

/// x, y and yaw, reaching the velocities of their targets together: a stand, for one. Acceleration and jerk are shared by x
/// and y as plan_plane shares them; positions and speeds play no part.
template <typename Real>
PlanResult plan_plane_velocity(const AxisState<Real> (&start)[3], const AxisState<Real> (&target)[3], const PlaneLimits<Real>& plane,
                               const AxisLimits<Real>& yaw, Trajectory<Real> (&trajectories)[3]);

/// For comparison: plan_bang_bang in the plane. x and y share the circle so that both are equally slow; yaw is on its own.
template <typename Real>
PlanResult plan_plane_bang_bang(const AxisState<Real> (&start)[3], const AxisState<Real> (&target)[3], const PlaneLimits<Real>& plane,
                                const AxisLimits<Real>& yaw, Trajectory<Real> (&trajectories)[3], Target how = Target::at_position);

}  // namespace robot_core
