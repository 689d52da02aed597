// Arrival times of one axis: the earliest one, and the earliest one not before a given time. Part of the trajectory planner.
#pragma once

#include <limits>

#include "robot_core/math.h"
#include "robot_core/trajectory_ascent.h"
#include "robot_core/trajectory_brake.h"
#include "robot_core/trajectory_meet.h"
#include "robot_core/trajectory_path.h"

namespace robot_core::detail {

/// Ascent of a problem, and its descent, which is the ascent of the mirrored problem.
template <typename Real>
struct Families {
  Ascent<Real> up;
  Ascent<Real> down;
};

template <typename Real>
Families<Real> families_of(const Problem<Real>& p) {
  const Real half0 = p.a0 * p.a0 / Real(2);
  const Real half1 = p.a1 * p.a1 / Real(2);
  const Real tolerance = smaller(kTouch<Real>, Real(8) * kRounding<Real>) * (absolute(p.v0) + absolute(p.v1) + half0 + half1);
  // Ends on one parabola count as such despite rounding; otherwise the motion along it would be missed.
  const auto or_zero = [tolerance](Real difference) { return absolute(difference) <= tolerance ? Real(0) : difference; };
  const Real up = or_zero((p.v1 - p.v0) + (half0 - half1));
  const Real down = or_zero((p.v0 - p.v1) + (half0 - half1));
  const Leg<Real> up0{p.v0 - half0, p.a0, larger(p.acceleration_max, p.a0)};
  const Leg<Real> up1{p.v1 - half1, -p.a1, larger(p.acceleration_min, -p.a1)};
  const Leg<Real> down0{-p.v0 - half0, -p.a0, larger(p.acceleration_min, -p.a0)};
  const Leg<Real> down1{-p.v1 - half1, p.a1, larger(p.acceleration_max, p.a1)};
  return {make_ascent(up0, up1, up, down, p.velocity_max, p.distance, p.distance_scale),
          make_ascent(down0, down1, down, up, p.velocity_min, -p.distance, p.distance_scale)};
}

template <typename Real>
Real duration_of(const Ascent<Real>& a, const Shape<Real>& shape) {
  // Sum leg by leg, so that a short motion between large accelerations keeps its digits.
  return larger(shape.slope_low - a.low.entry, Real(0)) + larger(shape.slope_high - a.high.entry, Real(0)) + shape.hold_low +
         shape.hold_high + shape.fall + shape.cruise;
}

template <typename Real>
Extreme<Real> path_of(const Ascent<Real>& a, const Shape<Real>& shape, Real sign) {
  const bool forward = a.low_is_start;
  const Leg<Real>& start = forward ? a.low : a.high;
  const Leg<Real>& end = forward ? a.high : a.low;
  const Real start_slope = forward ? shape.slope_low : shape.slope_high;
  const Real end_slope = forward ? shape.slope_high : shape.slope_low;
  // Leave out a change of slope that is only a rounding error.
  const auto beyond = [](Real slope, Real entry) {
    const Real difference = slope - entry;
    return difference > Real(4) * std::numeric_limits<Real>::epsilon() * slope ? difference : Real(0);
  };
  Extreme<Real> path;
  path.add(beyond(start_slope, start.entry), sign);
  path.add(forward ? shape.hold_low : shape.hold_high, Real(0));
  if (shape.cruise > Real(0)) {
    path.add(start_slope, -sign);
    path.add(shape.cruise, Real(0));
    path.add(end_slope, -sign);
  } else {
    path.add(shape.fall, -sign);
  }
  path.add(forward ? shape.hold_high : shape.hold_low, Real(0));
  path.add(beyond(end_slope, end.entry), sign);
  return path;
}

/// Widest or lowest motion that arrives.
template <typename Real>
struct Arrival {
  bool is_up;
  Shape<Real> shape;
  Real duration_s;
};

template <typename Real>
Arrival<Real> arrival(const Families<Real>& f, bool is_up, const Shape<Real>& shape) {
  return {is_up, shape, duration_of(is_up ? f.up : f.down, shape)};
}

/// Finds an arrival at the start or end of the gap, where both families have the same motion. Returns false if there is none.
template <typename Real>
bool arrive_at_edge(const Families<Real>& f, bool is_end, Arrival<Real>& found) {
  const bool is_up = f.up.has_gap;
  const Ascent<Real>& a = is_up ? f.up : f.down;
  Shape<Real> shape{};
  if (!a.has_gap || !meet_at_edge(a, false, is_end ? Real(1) : Real(-1), shape)) {
    return false;
  }
  found = arrival(f, is_up, shape);
  return true;
}

/// Returns the first arrival after the gap. Both families have one; the family `one_is_up` has it for certain.
template <typename Real>
Arrival<Real> arrival_after_gap(const Families<Real>& f, bool one_is_up) {
  if (Arrival<Real> edge{}; arrive_at_edge(f, true, edge)) {
    return edge;
  }
  const Ascent<Real>& one = one_is_up ? f.up : f.down;
  const Ascent<Real>& other = one_is_up ? f.down : f.up;
  Shape<Real> shape{};
  const Place<Real> place = lowest_top(one);
  if (one.goal >= place.distance || is_met(one, place)) {
    if (!touch(one, place, shape)) {
      meet(one, place, shape);
    }
    return arrival(f, one_is_up, shape);
  }
  Place<Real> other_place = lowest_top(other);
  if (!other.has_gap) {
    // The gap is so short that rounding hides it here.
    Place<Real> later{};
    at_duration(other, top_duration(one, place) - one.entries + other.entries, later);
    other_place = !later.is_saddle && later.at > other_place.at ? later : other_place;
  }
  if (!touch(other, other_place, shape)) {
    meet(other, other_place, shape);
  }
  return arrival(f, !one_is_up, shape);
}

/// Finds the first arrival before the gap. Returns false if there is none; `is_up` is then the family that misses the goal.
template <typename Real>
bool arrive_before_gap(const Families<Real>& f, bool& is_up, Arrival<Real>& found) {
  Place<Real> place = shortest(f.up);
  is_up = f.up.goal >= place.distance;
  if (!is_up) {
    const bool is_met_by_up = is_met(f.up, place);
    place = shortest(f.down);
    if (is_met_by_up || !(f.down.goal > place.distance)) {
      found = arrival(f, false, shape_at(f.down, place));
      return true;
    }
  }
  const Ascent<Real>& a = is_up ? f.up : f.down;
  Shape<Real> shape{};
  if (touch(a, place, shape) || meet_at_shortest(a, place, shape) || meet(a, place, shape)) {
    found = arrival(f, is_up, shape);
    return true;
  }
  return arrive_at_edge(f, false, found);
}

/// Uses one segment of full jerk if it meets the target within rounding, because no change of acceleration is faster. Such ends lie at a
/// corner of the reachable set: a rounding error beyond it, the next arrival comes much later.
template <typename Real>
bool arrive_in_one(const Problem<Real>& p, const Families<Real>& f, Arrival<Real>& found) {
  const Real change = p.a1 - p.a0;
  const Real time = absolute(change);
  const Real speed = absolute(p.v0) + absolute(p.v1) + time * (absolute(p.a0) + absolute(p.a1));
  const Real missed_velocity = p.v1 - p.v0 - time * (p.a0 + p.a1) / Real(2);
  const Real missed_distance = p.distance - time * (p.v0 + time * (p.a0 / Real(2) + change / Real(6)));
  if (!(time > Real(0)) || absolute(missed_velocity) > kRounding<Real> * speed ||
      absolute(missed_distance) > kRounding<Real> * (p.distance_scale + Real(8) * time * speed)) {
    return false;
  }
  const Real start_slope = larger(p.a0, p.a1);
  Shape<Real> shape{};
  shape.slope_low = f.up.low_is_start ? start_slope : -p.a1;
  shape.slope_high = f.up.low_is_start ? -p.a1 : start_slope;
  shape.fall = start_slope - p.a1;
  shape.distance = f.up.goal;
  found = {true, shape, time};
  return true;
}

/// Arrival of a given duration, or the next possible one.
template <typename Real>
struct Timed {
  bool is_extreme;
  Arrival<Real> extreme;
  Shape<Real> up;
  Shape<Real> down;
  Real duration_s;
};

template <typename Real>
void set_extreme(Timed<Real>& timed, const Arrival<Real>& found, Real not_before_s) {
  timed.is_extreme = true;
  timed.extreme = found;
  timed.duration_s = larger(not_before_s, found.duration_s);
}

/// Finds an arrival at `duration_s` or as soon afterwards as possible, but before the gap. Returns false if there is none; `is_up` is then
/// the family that misses the goal.
template <typename Real>
bool arrive_before_gap_from(const Families<Real>& f, Real duration_s, bool& is_up, Timed<Real>& timed) {
  is_up = true;
  const Real up_duration_s = duration_s + f.up.entries;
  if (f.up.has_gap && up_duration_s > saddle_duration(f.up, f.up.gap) && up_duration_s < top_duration(f.up, lowest_top(f.up))) {
    return false;
  }
  Place<Real> up_place{};
  Place<Real> down_place{};
  timed.up = at_duration(f.up, up_duration_s, up_place);
  timed.down = at_duration(f.down, duration_s + f.down.entries, down_place);
  const Real tolerance = kRounding<Real> * (f.up.goal_scale + absolute(up_place.distance) + absolute(down_place.distance));
  is_up = f.up.goal - up_place.distance > tolerance;
  if (is_up || f.down.goal - down_place.distance > tolerance) {
    Shape<Real> shape{};
    if (!(is_up ? meet(f.up, up_place, shape) : meet(f.down, down_place, shape))) {
      return false;
    }
    set_extreme(timed, arrival(f, is_up, shape), duration_s);
    return true;
  }
  timed.is_extreme = false;
  timed.duration_s = duration_s;
  return true;
}

template <typename Real>
void append_timed(const Families<Real>& f, const Timed<Real>& timed, Way<Real>& way) {
  if (timed.is_extreme) {
    const Ascent<Real>& a = timed.extreme.is_up ? f.up : f.down;
    append(path_of(a, timed.extreme.shape, timed.extreme.is_up ? Real(1) : Real(-1)), way);
    return;
  }
  const Real too_far = larger(timed.up.distance - f.up.goal, Real(0));
  const Real too_short = larger(timed.down.distance - f.down.goal, Real(0));
  const Real both = too_far + too_short;
  const Real up_share = both > Real(0) ? too_short / both : Real(1);
  append_blend(path_of(f.up, timed.up, Real(1)), path_of(f.down, timed.down, Real(-1)), up_share, timed.duration_s, way);
}

/// One axis, prepared for arrive_first() and arrive_from().
template <typename Real>
struct Axis {  // NOLINT(cppcoreguidelines-pro-type-member-init): pose_axis() fills it
  Problem<Real> problem;
  Families<Real> families;
  /// Motions without a brake, for a start that will inevitably break a velocity limit but may arrive before. They are used only before
  /// their gap: there the acceleration never changes its sign.
  Families<Real> early;
  Arrival<Real> in_one;
  bool may_be_early;     ///< true if there are early motions
  bool is_in_one;        ///< true if the first arrival after the brake takes one segment
  bool is_early_in_one;  ///< true if the first early arrival takes one segment
};

template <typename Real>
PlanResult pose_axis(const AxisState<Real>& start, const AxisState<Real>& target, const AxisLimits<Real>& limits, Target how,
                     Axis<Real>& axis) {
  if (const PlanResult result = pose(start, target, limits, how, axis.problem); result != PlanResult::ok) {
    return result;
  }
  axis.may_be_early = false;
  axis.is_early_in_one = false;
  Problem<Real>& p = axis.problem;
  const bool will_violate = violates_later(p);
  if (will_violate) {
    axis.early = families_of(p);
    axis.may_be_early = axis.early.up.has_gap && axis.early.down.has_gap;
    axis.is_early_in_one = !(p.a0 * p.a1 < Real(0)) && arrive_in_one(p, axis.early, axis.in_one);
  }
  leave_violation(p);
  axis.families = families_of(p);
  axis.is_in_one = !axis.is_early_in_one && arrive_in_one(p, axis.families, axis.in_one);
  return PlanResult::ok;
}

/// Arrival of an axis, and the family of motions that it uses.
template <typename Real>
struct AxisArrival {
  bool is_early;
  Timed<Real> timed;
  Real duration_s;  ///< duration including the brake
};

template <typename Real>
void arrive_first(const Axis<Real>& axis, AxisArrival<Real>& arrival) {
  bool is_up = true;
  Timed<Real>& timed = arrival.timed;
  timed.is_extreme = true;
  if (axis.is_in_one || axis.is_early_in_one) {
    arrival.is_early = axis.is_early_in_one;
    timed.extreme = axis.in_one;
  } else {
    arrival.is_early = axis.may_be_early && arrive_before_gap(axis.early, is_up, timed.extreme);
    if (!arrival.is_early && !arrive_before_gap(axis.families, is_up, timed.extreme)) {
      timed.extreme = arrival_after_gap(axis.families, is_up);
    }
  }
  timed.duration_s = timed.extreme.duration_s;
  arrival.duration_s = timed.duration_s + (arrival.is_early ? Real(0) : axis.problem.brake_s);
}

/// Finds the first arrival not before `duration_s`, which must not be below the duration of arrive_first().
template <typename Real>
void arrive_from(const Axis<Real>& axis, Real duration_s, AxisArrival<Real>& arrival) {
  bool is_up = true;
  Timed<Real>& timed = arrival.timed;
  const Ascent<Real>& early = axis.early.up;
  arrival.is_early = axis.may_be_early && duration_s + early.entries <= saddle_duration(early, early.gap) &&
                     arrive_before_gap_from(axis.early, duration_s, is_up, timed);
  if (arrival.is_early) {
    arrival.duration_s = timed.duration_s;
    return;
  }
  const Real brake_s = axis.problem.brake_s;
  Arrival<Real> first{};
  if (axis.may_be_early) {
    // The braked motions start later than the early ones end.
    const bool arrives = arrive_before_gap(axis.families, is_up, first);
    if (!arrives) {
      first = arrival_after_gap(axis.families, is_up);
    }
    if (first.duration_s + brake_s >= duration_s) {
      set_extreme(timed, first, first.duration_s);
      arrival.duration_s = first.duration_s + brake_s;
      return;
    }
  }
  if (!arrive_before_gap_from(axis.families, duration_s - brake_s, is_up, timed)) {
    set_extreme(timed, arrival_after_gap(axis.families, is_up), duration_s - brake_s);
  }
  arrival.duration_s = timed.is_extreme ? larger(timed.duration_s + brake_s, duration_s) : duration_s;
}

template <typename Real>
void append_arrival(const Axis<Real>& axis, const AxisArrival<Real>& arrival, Way<Real>& way) {
  if (arrival.is_early) {
    append_timed(axis.early, arrival.timed, way);
    return;
  }
  for (int i = 0; i < axis.problem.brake.count; ++i) {
    way.add(axis.problem.brake.duration_s[i], axis.problem.brake.jerk[i]);
  }
  append_timed(axis.families, arrival.timed, way);
}

/// Returns the duration of plan_position(), or the largest number if there is no plan.
template <typename Real>
Real earliest_arrival_s(const AxisState<Real>& start, const AxisState<Real>& target, const AxisLimits<Real>& limits, Target how) {
  Axis<Real> axis;
  if (pose_axis(start, target, limits, how, axis) != PlanResult::ok) {
    return std::numeric_limits<Real>::max();
  }
  AxisArrival<Real> arrival;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled in next
  arrive_first(axis, arrival);
  return arrival.duration_s;
}

}  // namespace robot_core::detail
