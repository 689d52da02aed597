// Segments of constant jerk, before they become segments of a trajectory. Part of the trajectory planner. The unit of jerk is the axis'
// jerk_max, as in trajectory_ascent.h.
#pragma once

#include <limits>

#include "robot_core/math.h"
#include "robot_core/trajectory.h"
#include "robot_core/trajectory_limits.h"

namespace robot_core::detail {

/// Durations of consecutive segments and the jerk of each, in units of jerk_max.
template <typename Real, int most>
struct Path {  // NOLINT(cppcoreguidelines-pro-type-member-init): only `count` of the places hold values
  int count = 0;
  Real duration_s[static_cast<unsigned>(most)];
  Real jerk[static_cast<unsigned>(most)];

  void add(Real for_s, Real with_jerk) {
    if (!(for_s > Real(0))) {
      return;
    }
    if (count > 0 && jerk[count - 1] == with_jerk) {
      duration_s[count - 1] += for_s;
      return;
    }
    duration_s[count] = for_s;
    jerk[count] = with_jerk;
    ++count;
  }
};

template <typename Real>
using Way = Path<Real, Trajectory<Real>::kMostSegments>;
template <typename Real>
using Extreme = Path<Real, 7>;

template <typename Real>
void append(const Extreme<Real>& path, Way<Real>& way) {
  for (int i = 0; i < path.count; ++i) {
    way.add(path.duration_s[i], path.jerk[i]);
  }
}

/// Position in a motion that is read from one of its ends.
template <typename Real>
struct Cursor {
  int at;
  Real left_s;  ///< time left in segment `at`
};

/// Appends the blend of two motions, each with its fraction of the jerk. Times are counted from the nearer end, so that short segments
/// there stay exact. The rounding errors go into the segment between, such as a long cruise.
template <typename Real>
void append_blend(const Extreme<Real>& up, const Extreme<Real>& down, Real up_share, Real duration_s, Way<Real>& way) {
  if (up.count == 0 || down.count == 0) {
    return;
  }
  const Extreme<Real>* const motions[2] = {&up, &down};
  Cursor<Real> front[2];
  Cursor<Real> back[2];
  for (int k = 0; k < 2; ++k) {
    front[k] = {0, motions[k]->duration_s[0]};
    back[k] = {motions[k]->count - 1, motions[k]->duration_s[motions[k]->count - 1]};
  }
  const auto jerk = [&](const Cursor<Real>(&at)[2]) { return up_share * up.jerk[at[0].at] + (Real(1) - up_share) * down.jerk[at[1].at]; };
  const auto next_of = [&](const Cursor<Real>(&at)[2]) {
    const bool up_ends = front[0].at < back[0].at;
    const bool down_ends = front[1].at < back[1].at;
    return up_ends && (!down_ends || at[0].left_s < at[1].left_s) ? 0 : 1;
  };
  // Steps to the nearest change of either jerk. Leaves out a step that exists only by rounding.
  const auto step = [](Cursor<Real>(&at)[2], int which, const Extreme<Real>& motion, int forward, Real& passed_s) {
    const Real step_s = larger(at[which].left_s, Real(0));
    at[1 - which].left_s -= step_s;
    at[which].at += forward;
    at[which].left_s = motion.duration_s[at[which].at];
    passed_s += step_s;
    return step_s > Real(4) * std::numeric_limits<Real>::epsilon() * passed_s ? step_s : Real(0);
  };
  Extreme<Real> tail[2];
  Real from_front_s = 0;
  Real from_back_s = 0;
  while (front[0].at < back[0].at || front[1].at < back[1].at) {
    const int first = next_of(front);
    const int last = next_of(back);
    if (from_front_s + front[first].left_s <= from_back_s + back[last].left_s) {
      const Real with = jerk(front);
      way.add(step(front, first, *motions[first], 1, from_front_s), with);
    } else {
      const Real with = jerk(back);
      Extreme<Real>& half = tail[0].count < 7 ? tail[0] : tail[1];
      half.add(step(back, last, *motions[last], -1, from_back_s), with);
    }
  }
  way.add(duration_s - from_front_s - from_back_s, jerk(front));
  for (int half = 1; half >= 0; --half) {
    for (int i = tail[half].count - 1; i >= 0; --i) {
      way.add(tail[half].duration_s[i], tail[half].jerk[i]);
    }
  }
}

/// Returns the nearest of `low`, 0 and `high` if `value` differs from it by a rounding error, else `value`. The error is relative to
/// `scale`: `at_limit` at `low` and `high`, kTouch at 0.
template <typename Real>
Real snapped(Real value, Real low, Real high, Real scale, Real at_limit) {
  const Real limit = value < Real(0) ? low : high;
  const Real nearest = absolute(value - limit) < absolute(value) ? limit : Real(0);
  const Real touch = nearest == Real(0) ? kTouch<Real> : at_limit;
  return absolute(value - nearest) <= touch * scale ? nearest : value;
}

/// Appends the path to the segments of the axis. Returns false if a number overflows.
template <typename Real>
bool lay_out_behind(const Way<Real>& way, const AxisLimits<Real>& limits, Trajectory<Real>& trajectory) {
  AxisState<Real> state = trajectory.target;
  Real time_s = trajectory.duration_s;
  Real most_acceleration = 0;
  Real most_velocity = 0;
  for (int i = 0; i < way.count; ++i) {
    const Real jerk = way.jerk[i] * limits.jerk_max;
    most_acceleration = larger(most_acceleration, absolute(state.acceleration));
    most_velocity = larger(most_velocity, absolute(state.velocity));
    if (jerk == Real(0)) {
      // Rounding errors would add up over a long hold or cruise. A blend may hold an acceleration close to the limit on purpose; moved
      // there, it would not return to 0.
      constexpr Real kHeld = kTouch<Real> / Real(4);
      state.acceleration = snapped(state.acceleration, limits.acceleration_min, limits.acceleration_max, most_acceleration, kHeld);
      if (state.acceleration == Real(0)) {
        state.velocity = snapped(state.velocity, limits.velocity_min, limits.velocity_max, most_velocity, kTouch<Real>);
      }
    }
    trajectory.segments[trajectory.segment_count + i] = {time_s, way.duration_s[i], jerk, state};
    state = Trajectory<Real>::advanced(state, jerk, way.duration_s[i]);
    time_s += way.duration_s[i];
  }
  trajectory.segment_count += way.count;
  trajectory.duration_s = time_s;
  trajectory.target = state;
  return is_finite(state.position) && is_finite(state.velocity) && is_finite(time_s);
}

/// Starts a trajectory at `start` without segments.
template <typename Real>
void begin_at(const AxisState<Real>& start, Trajectory<Real>& trajectory) {
  trajectory.segment_count = 0;
  trajectory.duration_s = 0;
  trajectory.target = start;
}

/// Returns true if velocity and acceleration keep the limits, except for rounding errors relative to the larger limit.
template <typename Real>
bool keeps_limits(const Trajectory<Real>& trajectory, const AxisLimits<Real>& limits) {
  constexpr Real kRelative = std::numeric_limits<Real>::digits > 32 ? Real(1e-10) : Real(4e-3);
  const Real velocity_room = kRelative * larger(limits.velocity_max, -limits.velocity_min);
  const Real acceleration_room = kRelative * larger(limits.acceleration_max, -limits.acceleration_min);
  const Real velocity_max = limits.velocity_max + velocity_room;
  const Real velocity_min = limits.velocity_min - velocity_room;
  const Real acceleration_max = limits.acceleration_max + acceleration_room;
  const Real acceleration_min = limits.acceleration_min - acceleration_room;
  unsigned breaks = 0;
  for (int i = 0; i < trajectory.segment_count; ++i) {
    const TrajectorySegment<Real>& s = trajectory.segments[i];
    const Real velocity = s.start.velocity;
    const Real slope = s.start.acceleration;
    const Real change = s.jerk * s.duration_s;
    // The velocity has an extremum where the acceleration passes zero. No branches, because no two paths are alike.
    const Real left = slope > Real(0) ? velocity_max - velocity : velocity - velocity_min;
    const auto turns = static_cast<unsigned>(slope * (slope + change) < Real(0));
    breaks |= turns & static_cast<unsigned>(slope * slope > Real(2) * absolute(s.jerk) * left);
    breaks |= static_cast<unsigned>(velocity > velocity_max) | static_cast<unsigned>(velocity < velocity_min) |
              static_cast<unsigned>(slope > acceleration_max) | static_cast<unsigned>(slope < acceleration_min);
  }
  return breaks == 0;
}

/// Returns the index of the segment that starts farthest out, or segment_count. `farthest` becomes the largest |position| of the path.
template <typename Real>
int farthest_change(const Trajectory<Real>& trajectory, Real& farthest) {
  int from = trajectory.segment_count;
  Real farthest_start = 0;
  for (int i = 0; i < trajectory.segment_count; ++i) {
    const TrajectorySegment<Real>& s = trajectory.segments[i];
    const Real far = absolute(s.start.position);
    if (i > 0 && far > farthest_start) {
      farthest_start = far;
      from = i;
    }
    farthest = larger(farthest, larger(far, absolute(Trajectory<Real>::advanced(s.start, s.jerk, s.duration_s / Real(2)).position)));
  }
  return from;
}

/// Closes the path at its target. The error at the end is the sum of its rounding errors. If it is visible beside the positions of start
/// and target, the path has gone far beyond them, and the error moves to the farthest segment boundary. Returns false if the end still
/// misses the target or the error is visible beside the whole path; `trajectory` is then empty. An axis that waits for others is blended
/// from motions that go further than itself, and has their rounding errors.
template <typename Real>
bool close_at(const AxisState<Real>& target, const AxisState<Real>& start, const AxisLimits<Real>& limits, bool waits,
              Trajectory<Real>& trajectory) {
  AxisState<Real> end = trajectory.target;
  trajectory.target = target;
  const Real asked = larger(absolute(start.position), absolute(target.position));
  const Real velocity = larger(limits.velocity_max, -limits.velocity_min);
  const Real acceleration = larger(limits.acceleration_max, -limits.acceleration_min);
  const Real missed = target.position - end.position;
  Real farthest = asked;
  // Infinite scales would accept any error, so the error itself must be finite.
  bool is_there = is_finite(missed);
  if (absolute(missed) > kTouch<Real> * asked) {
    const int from = farthest_change(trajectory, farthest);
    for (int i = from; i < trajectory.segment_count; ++i) {
      trajectory.segments[i].start.position += missed;
      is_there = is_there && is_finite(trajectory.segments[i].start.position);
    }
    if (from < trajectory.segment_count) {
      const TrajectorySegment<Real>& last = trajectory.segments[trajectory.segment_count - 1];
      end.position = Trajectory<Real>::advanced(last.start, last.jerk, last.duration_s).position;
    }
  }
  const Real reach = velocity * velocity / acceleration;
  const Real blended = waits ? velocity * trajectory.duration_s : Real(0);
  is_there = is_there && absolute(target.position - end.position) <= kArrival<Real> * (asked + reach) &&
             absolute(missed) <= kArrival<Real> * (farthest + reach + blended) &&
             absolute(target.velocity - end.velocity) <= kArrival<Real> * velocity &&
             absolute(target.acceleration - end.acceleration) <= kArrival<Real> * acceleration;
  trajectory.segment_count = is_there ? trajectory.segment_count : 0;
  return is_there;
}

}  // namespace robot_core::detail
