#include <limits>

#include "robot_core/trajectory.h"
#include "robot_core/trajectory_ascent.h"
#include "robot_core/trajectory_limits.h"
#include "robot_core/trajectory_path.h"

namespace robot_core {
namespace detail {
namespace {

/// Change of velocity of one axis in units of its jerk_max, from an acceleration inside the limits. The ramp is the shortest change of
/// acceleration from a0 to a1. `gain` is the required change of velocity beyond that of the ramp.
template <typename Real>
struct VelocityChange {
  Real highest, lowest;                     ///< larger and smaller one of a0 and a1
  Real acceleration_max, acceleration_min;  ///< the minimum as magnitude; a0 and a1 exceed both only by rounding
  bool rises;                               ///< true if a1 is above a0
  Real gain;
  Real scale;  ///< magnitude of the terms whose difference is `gain`
  Real brake_s;
  Real brake_jerk;
};

/// Motion upwards beyond the ramp (downwards with all signs reversed): from its higher end up, hold, and down again. It gains the most
/// velocity of all motions of that duration.
template <typename Real>
struct Swing {
  Real slope_s;
  Real hold_s;
  Real gain;
  Real extra_s() const { return Real(2) * slope_s + hold_s; }
};

/// Returns the shortest swing from the level `end` with a velocity gain `gain` > 0.
template <typename Real>
Swing<Real> swing_of_gain(Real end, Real bound, Real gain) {
  const Real top = square_root(end * end + gain);
  const Real slope_s = end > Real(0) ? gain / (end + top) : top - end;
  const Real most_s = bound - end;
  if (slope_s <= most_s) {
    return {slope_s, Real(0), gain};
  }
  return {most_s, (gain - most_s * (end + bound)) / bound, gain};
}

template <typename Real>
Swing<Real> swing_of_duration(Real end, Real bound, Real extra_s) {
  const Real slope_s = smaller(extra_s / Real(2), bound - end);
  const Real hold_s = extra_s - Real(2) * slope_s;
  return {slope_s, hold_s, slope_s * (Real(2) * end + slope_s) + hold_s * (end + slope_s)};
}

/// Change of velocity of a given duration: a blend of the swings in both directions.
template <typename Real>
struct TimedChange {
  Swing<Real> up;
  Swing<Real> down;
  Real up_share;
  Real duration_s;  ///< duration including the brake
};

template <typename Real>
void pose_change(const AxisState<Real>& start, const AxisState<Real>& target, const AxisLimits<Real>& limits, VelocityChange<Real>& c) {
  const Real over_jerk = Real(1) / limits.jerk_max;
  const Real excess = is_beyond(start.acceleration, limits.acceleration_min, limits.acceleration_max)
                          ? start.acceleration - clamped(start.acceleration, limits.acceleration_min, limits.acceleration_max)
                          : Real(0);
  const Real a0 = (start.acceleration - excess) * over_jerk;
  const Real a1 = target.acceleration * over_jerk;
  c.brake_s = absolute(excess) * over_jerk;
  c.brake_jerk = excess > Real(0) ? Real(-1) : Real(1);
  c.rises = a1 > a0;
  c.highest = larger(a0, a1);
  c.lowest = smaller(a0, a1);
  c.acceleration_max = larger(limits.acceleration_max * over_jerk, c.highest);
  c.acceleration_min = larger(-limits.acceleration_min * over_jerk, -c.lowest);
  const Real brake_gain = c.brake_s * (start.acceleration - excess / Real(2)) * over_jerk;
  const Real ramp_gain = (c.highest - c.lowest) * (c.highest + c.lowest) / Real(2);
  const Real change = (target.velocity - start.velocity) * over_jerk;
  c.gain = change - brake_gain - ramp_gain;
  c.scale = (absolute(target.velocity) + absolute(start.velocity)) * over_jerk + absolute(brake_gain) + absolute(ramp_gain);
}

template <typename Real>
Real ramp_s(const VelocityChange<Real>& c) {
  return c.brake_s + c.highest - c.lowest;
}

/// Finds the first change not shorter than `duration_s`.
template <typename Real>
void change_from(const VelocityChange<Real>& c, Real duration_s, TimedChange<Real>& timed) {
  const Real extra_s = larger(duration_s - ramp_s(c), Real(0));
  timed.up = swing_of_duration(c.highest, c.acceleration_max, extra_s);
  timed.down = swing_of_duration(-c.lowest, c.acceleration_min, extra_s);
  timed.duration_s = larger(duration_s, ramp_s(c));
  const Real tolerance = kRounding<Real> * (c.scale + absolute(timed.up.gain) + absolute(timed.down.gain));
  if (c.gain > timed.up.gain + (extra_s > Real(0) ? tolerance : Real(0))) {
    timed.up = swing_of_gain(c.highest, c.acceleration_max, c.gain);
    timed.up_share = Real(1);
    timed.duration_s = larger(duration_s, ramp_s(c) + timed.up.extra_s());
  } else if (-c.gain > timed.down.gain + (extra_s > Real(0) ? tolerance : Real(0))) {
    timed.down = swing_of_gain(-c.lowest, c.acceleration_min, -c.gain);
    timed.up_share = Real(0);
    timed.duration_s = larger(duration_s, ramp_s(c) + timed.down.extra_s());
  } else {
    const Real both = timed.up.gain + timed.down.gain;
    timed.up_share = both > Real(0) ? clamped((c.gain + timed.down.gain) / both, Real(0), Real(1)) : Real(1);
  }
}

template <typename Real>
Extreme<Real> path_of(const VelocityChange<Real>& c, const Swing<Real>& swing, Real sign) {
  const Real ramp = c.highest - c.lowest;
  const bool ramp_is_first = c.rises == (sign > Real(0));
  Extreme<Real> path;
  path.add(swing.slope_s + (ramp_is_first ? ramp : Real(0)), sign);
  path.add(swing.hold_s, Real(0));
  path.add(swing.slope_s + (ramp_is_first ? Real(0) : ramp), -sign);
  return path;
}

/// Corrects the longest hold by the velocity that is missing at the end. Rounding errors of a blended acceleration may be small beside the
/// limits but add up over a long hold.
template <typename Real>
void close_velocity(Real velocity, Trajectory<Real>& trajectory) {
  int hold = -1;
  for (int i = 0; i < trajectory.segment_count; ++i) {
    if (trajectory.segments[i].jerk == Real(0) && (hold < 0 || trajectory.segments[i].duration_s > trajectory.segments[hold].duration_s)) {
      hold = i;
    }
  }
  const Real missing = velocity - trajectory.target.velocity;
  if (hold < 0 || absolute(missing) <= kRounding<Real> * (absolute(velocity) + absolute(trajectory.segments[0].start.velocity))) {
    return;
  }
  trajectory.segments[hold].start.acceleration += missing / trajectory.segments[hold].duration_s;
  for (int i = hold; i < trajectory.segment_count; ++i) {
    const TrajectorySegment<Real>& segment = trajectory.segments[i];
    AxisState<Real>& next = i + 1 < trajectory.segment_count ? trajectory.segments[i + 1].start : trajectory.target;
    const AxisState<Real> end = Trajectory<Real>::advanced(segment.start, segment.jerk, segment.duration_s);
    next.position = end.position;
    next.velocity = end.velocity;
  }
}

template <typename Real>
bool lay_out_change(const VelocityChange<Real>& c, const TimedChange<Real>& timed, const AxisState<Real>& start,
                    const AxisState<Real>& target, const AxisLimits<Real>& limits, Trajectory<Real>& trajectory) {
  Way<Real> way;
  way.add(c.brake_s, c.brake_jerk);
  if (timed.up_share == Real(1)) {
    append(path_of(c, timed.up, Real(1)), way);
  } else if (timed.up_share == Real(0)) {
    append(path_of(c, timed.down, Real(-1)), way);
  } else {
    append_blend(path_of(c, timed.up, Real(1)), path_of(c, timed.down, Real(-1)), timed.up_share, timed.duration_s - c.brake_s, way);
  }
  begin_at(start, trajectory);
  if (!lay_out_behind(way, limits, trajectory)) {
    trajectory.segment_count = 0;
    return false;
  }
  if (timed.up_share > Real(0) && timed.up_share < Real(1)) {
    close_velocity(target.velocity, trajectory);
  }
  const AxisState<Real> end = trajectory.target;
  trajectory.target.velocity = target.velocity;
  trajectory.target.acceleration = target.acceleration;
  const Real slopes = absolute(c.highest) + absolute(c.lowest);
  const Real reach = (c.scale + slopes * slopes + absolute(timed.up.gain) + absolute(timed.down.gain)) * limits.jerk_max;
  const Real acceleration = larger(limits.acceleration_max, -limits.acceleration_min);
  const bool is_there = absolute(target.velocity - end.velocity) <= kArrival<Real> * reach &&
                        absolute(target.acceleration - end.acceleration) <= kArrival<Real> * acceleration;
  trajectory.segment_count = is_there ? trajectory.segment_count : 0;
  return is_there;
}

template <typename Real>
PlanResult check_change(const AxisState<Real>& start, const AxisState<Real>& target, const AxisLimits<Real>& limits) {
  if (!is_whole(start) || !is_finite(target.velocity) || !is_finite(target.acceleration)) {
    return PlanResult::not_finite;
  }
  if (const PlanResult result = check_limits(limits); result != PlanResult::ok) {
    return result;
  }
  return is_beyond(target.acceleration, limits.acceleration_min, limits.acceleration_max) ? PlanResult::target_acceleration_beyond_limit
                                                                                          : PlanResult::ok;
}

}  // namespace
}  // namespace detail

using namespace detail;

template <typename Real>
PlanResult plan_velocity_synchronised(int axis_count, const AxisState<Real>* start, const AxisState<Real>* target,
                                      const AxisLimits<Real>* limits, Trajectory<Real>* trajectories, int* failed_axis) {
  VelocityChange<Real> changes[kMostAxes];
  TimedChange<Real> timed[kMostAxes];
  if (!is_axis_count(axis_count)) {
    return PlanResult::not_that_many_axes;
  }
  const auto failed = [failed_axis](int axis, PlanResult result) {
    if (failed_axis != nullptr) {
      *failed_axis = axis;
    }
    return result;
  };
  Real duration_s = 0;
  for (int i = 0; i < axis_count; ++i) {
    if (const PlanResult result = check_change(start[i], target[i], limits[i]); result != PlanResult::ok) {
      return failed(i, result);
    }
    pose_change(start[i], target[i], limits[i], changes[i]);
    change_from(changes[i], Real(0), timed[i]);
    duration_s = larger(duration_s, timed[i].duration_s);
  }
  // Each axis has at most one interval of impossible durations, so it delays the arrival at most once.
  for (int delay = 0; delay <= axis_count; ++delay) {
    for (int i = 0; i < axis_count; ++i) {
      if (timed[i].duration_s != duration_s) {
        change_from(changes[i], duration_s, timed[i]);
        duration_s = timed[i].duration_s;
      }
    }
  }
  for (int i = 0; i < axis_count; ++i) {
    if (!lay_out_change(changes[i], timed[i], start[i], target[i], limits[i], trajectories[i])) {
      return failed(i, PlanResult::out_of_range);
    }
    trajectories[i].duration_s = duration_s;
  }
  return PlanResult::ok;
}

template <typename Real>
PlanResult plan_velocity(const AxisState<Real>& start, const AxisState<Real>& target, const AxisLimits<Real>& limits,
                         Trajectory<Real>& trajectory) {
  return plan_velocity_synchronised<Real>(1, &start, &target, &limits, &trajectory, nullptr);
}

#define ROBOT_CORE_INSTANTIATE(Real)                                                                                             \
  template PlanResult plan_velocity(const AxisState<Real>&, const AxisState<Real>&, const AxisLimits<Real>&, Trajectory<Real>&); \
  template PlanResult plan_velocity_synchronised(int, const AxisState<Real>*, const AxisState<Real>*, const AxisLimits<Real>*,   \
                                                 Trajectory<Real>*, int*)

ROBOT_CORE_INSTANTIATE(float);
#ifndef ROBOT_CORE_WITHOUT_DOUBLE
ROBOT_CORE_INSTANTIATE(double);
#endif

}  // namespace robot_core
