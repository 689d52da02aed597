#include "robot_core/trajectory.h"

#include "robot_core/trajectory_ascent.h"

namespace robot_core {
namespace detail {
namespace {

/// Durations and the jerk of each, in units of jerk_max.
template <typename Real, int most>
struct Path {  // NOLINT(cppcoreguidelines-pro-type-member-init): only `count` of the places hold values
  int count = 0;
  Real duration_s[most];
  Real jerk[most];

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

/// One axis in units of its jerk_max, after its brake.
template <typename Real>
struct Problem {  // NOLINT(cppcoreguidelines-pro-type-member-init): pose() fills it
  Real v0, a0, v1, a1;
  Real velocity_max, velocity_min, acceleration_max, acceleration_min;  ///< magnitudes of the minima
  Real distance;
  Real distance_scale;  ///< of the positions whose difference it is
  Real brake_s;
  Path<Real, 2> brake;
};

/// The ascent of a problem and, as the ascent of the mirrored problem, its descent.
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
  // Ends that lie on one parabola but for rounding: without this the motion along it would be missed.
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
  // Leg by leg, so that a short motion between large accelerations keeps its digits.
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
  // A limit that an end already has is left out, not approached by a rounding error.
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

/// A widest or lowest motion that arrives.
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

/// The first arrival behind the gap; both families have one, `one` for certain.
template <typename Real>
Arrival<Real> arrival_after_gap(const Families<Real>& f, bool one_is_up) {
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

/// The first arrival before the gap. False if there is none; `is_up` then tells where the goal was missed.
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
  if (touch(a, place, shape) || meet(a, place, shape)) {
    found = arrival(f, is_up, shape);
    return true;
  }
  return false;
}

/// An arrival of a given duration, or the next one possible.
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

/// An arrival in that time or as soon afterwards as possible, but before the gap. False if there is none; `is_up` then
/// tells where the goal was missed.
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
void append(const Extreme<Real>& path, Way<Real>& way) {
  for (int i = 0; i < path.count; ++i) {
    way.add(path.duration_s[i], path.jerk[i]);
  }
}

/// One end of a motion that is taken apart from both ends.
template <typename Real>
struct Cursor {
  int at;
  Real left_s;  ///< of the segment `at`
};

/// Both motions, each with its share of the jerk. Times are counted from the nearer end: what is short there stays exact
/// even beside a long cruise, where the rounding errors go.
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
  // The step to the nearest change of either jerk; a step that only rounding makes is left out.
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

/// `value`, or the one of `low`, 0 and `high` that it differs from by a rounding error of `scale`.
template <typename Real>
Real snapped(Real value, Real low, Real high, Real scale) {
  const Real tolerance = kTouch<Real> * scale;
  if (absolute(value) <= tolerance) {
    return Real(0);
  }
  return absolute(value - high) <= tolerance ? high : (absolute(value - low) <= tolerance ? low : value);
}

/// The way as segments of the axis. False if the numbers do not hold.
template <typename Real>
bool lay_out(const Way<Real>& way, const AxisState<Real>& start, const AxisLimits<Real>& limits, Trajectory<Real>& trajectory) {
  AxisState<Real> state = start;
  Real time_s = 0;
  Real most_acceleration = 0;
  Real most_velocity = 0;
  for (int i = 0; i < way.count; ++i) {
    const Real jerk = way.jerk[i] * limits.jerk_max;
    most_acceleration = larger(most_acceleration, absolute(state.acceleration));
    most_velocity = larger(most_velocity, absolute(state.velocity));
    if (jerk == Real(0)) {
      // Rounding errors would add up over a long hold or cruise.
      state.acceleration = snapped(state.acceleration, limits.acceleration_min, limits.acceleration_max, most_acceleration);
      if (state.acceleration == Real(0)) {
        state.velocity = snapped(state.velocity, limits.velocity_min, limits.velocity_max, most_velocity);
      }
    }
    trajectory.segments[i] = {time_s, way.duration_s[i], jerk, state};
    state = Trajectory<Real>::advanced(state, jerk, way.duration_s[i]);
    time_s += way.duration_s[i];
  }
  trajectory.segment_count = way.count;
  trajectory.duration_s = time_s;
  trajectory.target = state;
  return is_finite(state.position) && is_finite(state.velocity) && is_finite(time_s);
}

template <typename Real>
inline constexpr Real kLimitTolerance = Real(4096) * std::numeric_limits<Real>::epsilon();

/// Upwards too fast, now or inevitably soon: jerk down until the velocity is `velocity_max` again and sinking; but no
/// longer than `velocity_min` can still be kept.
template <typename Real>
void brake_velocity(Real& v, Real& a, Real velocity_max, Real velocity_min, Real acceleration_min, Real sign, Path<Real, 2>& brake) {
  const Real square = a * a / Real(2);
  const Real until_limit_s = a + square_root(Real(2) * (square + (v - velocity_max)));
  const Real until_last_s = a + square_root(square + (v + velocity_min));
  Real fall_s = smaller(until_limit_s, until_last_s);
  Real hold_s = 0;
  if (a + acceleration_min < fall_s) {
    fall_s = larger(a + acceleration_min, Real(0));
    const Real reached = v + fall_s * (a - fall_s / Real(2));
    const Real slope = larger(acceleration_min, fall_s - a);
    hold_s = larger(smaller((reached - velocity_max) / slope, (reached + velocity_min) / slope - slope / Real(2)), Real(0));
  }
  fall_s = larger(fall_s, Real(0));
  brake.add(fall_s, -sign);
  brake.add(hold_s, Real(0));
  v += fall_s * (a - fall_s / Real(2));
  a -= fall_s;
  v += hold_s * a;
}

/// Accelerating too much: jerk down to the limit, and on as long as a velocity limit asks for it.
template <typename Real>
void brake_acceleration(Real& v, Real& a, Real velocity_max, Real velocity_min, Real acceleration_max, Real acceleration_min, Real sign,
                        Path<Real, 2>& brake) {
  if (v + a * a / Real(2) > velocity_max) {
    brake_velocity(v, a, velocity_max, velocity_min, acceleration_min, sign, brake);
    return;
  }
  const Real fall_s = a - acceleration_max;
  const Real reached = v + fall_s * (a + acceleration_max) / Real(2);
  brake.add(fall_s, -sign);
  a = acceleration_max;
  v = reached;
  if (reached < -velocity_min) {
    const Real hold_s =
        smaller((-velocity_min - reached) / acceleration_max, (velocity_max - reached) / acceleration_max - acceleration_max / Real(2));
    brake.add(hold_s, Real(0));
    v += larger(hold_s, Real(0)) * a;
  }
}

/// Leads a start that violates limits back inside.
template <typename Real>
void leave_violation(Problem<Real>& p) {
  AxisState<Real> state{Real(0), p.v0, p.a0};
  const Real tolerance = kLimitTolerance<Real>;
  const Real square = p.a0 * p.a0 / Real(2);
  const Real velocity_tolerance = tolerance * (absolute(p.v0) + square);
  const auto mirrored = [&p](auto brake, auto... arguments) {
    p.v0 = -p.v0;
    p.a0 = -p.a0;
    brake(p.v0, p.a0, p.velocity_min, p.velocity_max, arguments..., Real(-1), p.brake);
    p.v0 = -p.v0;
    p.a0 = -p.a0;
  };
  const Real straight = p.a0 > Real(0) ? p.v0 + square : p.v0;
  const Real straight_down = p.a0 < Real(0) ? p.v0 - square : p.v0;
  if (p.a0 > p.acceleration_max * (Real(1) + tolerance)) {
    brake_acceleration(p.v0, p.a0, p.velocity_max, p.velocity_min, p.acceleration_max, p.acceleration_min, Real(1), p.brake);
  } else if (p.a0 < -p.acceleration_min * (Real(1) + tolerance)) {
    mirrored(brake_acceleration<Real>, p.acceleration_min, p.acceleration_max);
  } else if (straight > p.velocity_max + velocity_tolerance && (p.a0 > Real(0) || p.v0 - square > -p.velocity_min)) {
    brake_velocity(p.v0, p.a0, p.velocity_max, p.velocity_min, p.acceleration_min, Real(1), p.brake);
  } else if (straight_down < -p.velocity_min - velocity_tolerance && (p.a0 < Real(0) || p.v0 + square < p.velocity_max)) {
    mirrored(brake_velocity<Real>, p.acceleration_max);
  }
  p.brake_s = 0;
  for (int i = 0; i < p.brake.count; ++i) {
    p.brake_s += p.brake.duration_s[i];
    state = Trajectory<Real>::advanced(state, p.brake.jerk[i], p.brake.duration_s[i]);
  }
  p.distance -= state.position;
  p.distance_scale += absolute(state.position);
}

/// No limit is violated yet, but a velocity limit inevitably will be, unless the motion ends before.
template <typename Real>
bool violates_later(const Problem<Real>& p) {
  const Real tolerance = kLimitTolerance<Real>;
  const Real square = p.a0 * p.a0 / Real(2);
  const Real velocity_tolerance = tolerance * (absolute(p.v0) + square);
  const bool is_inside = p.v0 <= p.velocity_max + velocity_tolerance && p.v0 >= -p.velocity_min - velocity_tolerance &&
                         p.a0 <= p.acceleration_max * (Real(1) + tolerance) && p.a0 >= -p.acceleration_min * (Real(1) + tolerance);
  return is_inside &&
         (p.a0 > Real(0) ? p.v0 + square > p.velocity_max + velocity_tolerance : p.v0 - square < -p.velocity_min - velocity_tolerance);
}

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

/// Everything in units of jerk_max, in the frame of a target that moves on.
template <typename Real>
PlanResult pose(const AxisState<Real>& start, const AxisState<Real>& target, const AxisLimits<Real>& limits, Target how, Problem<Real>& p) {
  if (!is_whole(start) || !is_whole(target)) {
    return PlanResult::not_finite;
  }
  if (const PlanResult result = check_limits(limits); result != PlanResult::ok) {
    return result;
  }
  if (is_beyond(target.velocity, limits.velocity_min, limits.velocity_max)) {
    return PlanResult::target_velocity_beyond_limit;
  }
  const bool moves = how == Target::moving_on;
  if (moves && !(target.velocity < limits.velocity_max && target.velocity > limits.velocity_min)) {
    return PlanResult::target_velocity_beyond_limit;
  }
  if (!moves && is_beyond(target.acceleration, limits.acceleration_min, limits.acceleration_max)) {
    return PlanResult::target_acceleration_beyond_limit;
  }
  const Real over_jerk = Real(1) / limits.jerk_max;
  const Real frame = moves ? target.velocity : Real(0);
  p.v0 = (start.velocity - frame) * over_jerk;
  p.a0 = start.acceleration * over_jerk;
  p.v1 = moves ? Real(0) : target.velocity * over_jerk;
  p.a1 = moves ? Real(0) : target.acceleration * over_jerk;
  p.velocity_max = (limits.velocity_max - frame) * over_jerk;
  p.velocity_min = (frame - limits.velocity_min) * over_jerk;
  p.acceleration_max = limits.acceleration_max * over_jerk;
  p.acceleration_min = -limits.acceleration_min * over_jerk;
  const Real square = p.a1 * p.a1 / Real(2);
  const Real tolerance = kLimitTolerance<Real> * (absolute(p.v1) + square);
  if ((p.a1 > Real(0) && p.v1 - square < -p.velocity_min - tolerance) || (p.a1 < Real(0) && p.v1 + square > p.velocity_max + tolerance)) {
    return PlanResult::target_without_approach;
  }
  p.distance = (target.position - start.position) * over_jerk;
  p.distance_scale = (absolute(target.position) + absolute(start.position)) * over_jerk;
  return PlanResult::ok;
}

/// One axis, ready to be asked for arrivals.
template <typename Real>
struct Axis {  // NOLINT(cppcoreguidelines-pro-type-member-init): pose_axis() fills it
  Problem<Real> problem;
  Families<Real> families;
  /// A start that will inevitably break a velocity limit may still arrive before. Then these are the motions without a
  /// brake, of use only before their gap: in them the acceleration never changes its sign.
  bool may_be_early;
  Families<Real> early;
};

template <typename Real>
PlanResult pose_axis(const AxisState<Real>& start, const AxisState<Real>& target, const AxisLimits<Real>& limits, Target how,
                     Axis<Real>& axis) {
  if (const PlanResult result = pose(start, target, limits, how, axis.problem); result != PlanResult::ok) {
    return result;
  }
  axis.may_be_early = false;
  Problem<Real>& p = axis.problem;
  const bool will_violate = violates_later(p);
  if (will_violate) {
    axis.early = families_of(p);
    axis.may_be_early = axis.early.up.has_gap && axis.early.down.has_gap;
  }
  leave_violation(p);
  axis.families = families_of(p);
  return PlanResult::ok;
}

/// An arrival of an axis, and by which of its motions.
template <typename Real>
struct AxisArrival {
  bool is_early;
  Timed<Real> timed;
  Real duration_s;  ///< with the brake
};

template <typename Real>
void arrive_first(const Axis<Real>& axis, AxisArrival<Real>& arrival) {
  bool is_up = true;
  Timed<Real>& timed = arrival.timed;
  timed.is_extreme = true;
  arrival.is_early = axis.may_be_early && arrive_before_gap(axis.early, is_up, timed.extreme);
  if (!arrival.is_early && !arrive_before_gap(axis.families, is_up, timed.extreme)) {
    timed.extreme = arrival_after_gap(axis.families, is_up);
  }
  timed.duration_s = timed.extreme.duration_s;
  arrival.duration_s = timed.duration_s + (arrival.is_early ? Real(0) : axis.problem.brake_s);
}

/// The first arrival not before `duration_s`; no less than the one of arrive_first.
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
    // The braked motions start later than the others end.
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

template <typename Real>
PlanResult finish(const Way<Real>& way, const AxisState<Real>& start, const AxisState<Real>& target, const AxisLimits<Real>& limits,
                  Target how, Trajectory<Real>& trajectory) {
  if (!lay_out(way, start, limits, trajectory)) {
    trajectory.segment_count = 0;
    return PlanResult::out_of_range;
  }
  trajectory.target = target;
  if (how == Target::moving_on) {
    trajectory.target.position += target.velocity * trajectory.duration_s;
    trajectory.target.acceleration = Real(0);
  }
  return PlanResult::ok;
}

}  // namespace
}  // namespace detail

using namespace detail;

template <typename Real>
PlanResult plan_position(const AxisState<Real>& start, const AxisState<Real>& target, const AxisLimits<Real>& limits,
                         Trajectory<Real>& trajectory, Target how) {
  Axis<Real> axis;
  if (const PlanResult result = pose_axis(start, target, limits, how, axis); result != PlanResult::ok) {
    return result;
  }
  AxisArrival<Real> arrival;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled in next
  arrive_first(axis, arrival);
  Way<Real> way;
  append_arrival(axis, arrival, way);
  return finish(way, start, target, limits, how, trajectory);
}

template <typename Real>
PlanResult plan_velocity(const AxisState<Real>& start, const AxisState<Real>& target, const AxisLimits<Real>& limits,
                         Trajectory<Real>& trajectory) {
  if (!is_whole(start) || !is_finite(target.velocity) || !is_finite(target.acceleration)) {
    return PlanResult::not_finite;
  }
  if (const PlanResult result = check_limits(limits); result != PlanResult::ok) {
    return result;
  }
  if (is_beyond(target.acceleration, limits.acceleration_min, limits.acceleration_max)) {
    return PlanResult::target_acceleration_beyond_limit;
  }
  const Real over_jerk = Real(1) / limits.jerk_max;
  Problem<Real> p;
  p.a0 = start.acceleration * over_jerk;
  p.v0 = Real(0);
  p.a1 = target.acceleration * over_jerk;
  p.v1 = (target.velocity - start.velocity) * over_jerk;
  p.acceleration_max = limits.acceleration_max * over_jerk;
  p.acceleration_min = -limits.acceleration_min * over_jerk;
  p.velocity_max = Real(0);
  p.velocity_min = Real(0);
  p.distance = Real(0);
  p.distance_scale = Real(0);
  const Real excess = is_beyond(start.acceleration, limits.acceleration_min, limits.acceleration_max)
                          ? p.a0 - clamped(p.a0, -p.acceleration_min, p.acceleration_max)
                          : Real(0);
  Way<Real> way;
  way.add(absolute(excess), excess > Real(0) ? Real(-1) : Real(1));
  p.v0 += absolute(excess) * (p.a0 - excess / Real(2));
  p.a0 -= excess;
  const Families<Real> families = families_of(p);
  append(path_of(families.up, shape_at(families.up, shortest(families.up)), Real(1)), way);
  if (!lay_out(way, start, limits, trajectory)) {
    trajectory.segment_count = 0;
    return PlanResult::out_of_range;
  }
  trajectory.target.velocity = target.velocity;
  trajectory.target.acceleration = target.acceleration;
  return PlanResult::ok;
}

template <typename Real>
PlanResult plan_bang_bang(const AxisState<Real>& start, const AxisState<Real>& target, const AxisLimits<Real>& limits,
                          Trajectory<Real>& trajectory, Target how) {
  if (!is_finite(start.position) || !is_finite(start.velocity) || !is_finite(target.position) || !is_finite(target.velocity)) {
    return PlanResult::not_finite;
  }
  AxisLimits<Real> whole = limits;
  whole.jerk_max = Real(1);
  if (const PlanResult result = check_limits(whole); result != PlanResult::ok) {
    return result;
  }
  const Real frame = how == Target::moving_on ? target.velocity : Real(0);
  if (is_beyond(target.velocity, limits.velocity_min, limits.velocity_max) ||
      (how == Target::moving_on && !(frame < limits.velocity_max && frame > limits.velocity_min))) {
    return PlanResult::target_velocity_beyond_limit;
  }
  const Real upper = limits.velocity_max - frame;
  const Real lower = limits.velocity_min - frame;
  const Real v1 = target.velocity - frame;
  AxisState<Real> state{start.position, start.velocity, Real(0)};
  Real time_s = 0;
  trajectory.segment_count = 0;
  const auto add = [&](Real for_s, Real acceleration) {
    if (for_s > Real(0)) {
      state.acceleration = acceleration;
      trajectory.segments[trajectory.segment_count] = {time_s, for_s, Real(0), state};
      ++trajectory.segment_count;
      time_s += for_s;
      state = Trajectory<Real>::advanced(state, Real(0), for_s);
    }
  };
  Real v0 = start.velocity - frame;
  const Real within = clamped(v0, lower, upper);
  add(absolute((v0 - within) / (v0 > within ? limits.acceleration_min : limits.acceleration_max)),
      v0 > within ? limits.acceleration_min : limits.acceleration_max);
  Real distance = target.position - state.position + frame * time_s;
  v0 = within;
  // The direct change of velocity tells the direction.
  const Real direct = (v1 * v1 - v0 * v0) / (Real(2) * (v1 > v0 ? limits.acceleration_max : limits.acceleration_min));
  const Real sign = distance < direct ? Real(-1) : Real(1);
  const Real raise = sign > Real(0) ? limits.acceleration_max : -limits.acceleration_min;
  const Real fall = sign > Real(0) ? -limits.acceleration_min : limits.acceleration_max;
  const Real limit = sign > Real(0) ? upper : -lower;
  const Real square = (sign * distance + v0 * v0 / (Real(2) * raise) + v1 * v1 / (Real(2) * fall)) /
                      (Real(1) / (Real(2) * raise) + Real(1) / (Real(2) * fall));
  const Real top = larger(square_root(square), larger(sign * v0, sign * v1));
  const Real reached = smaller(top, larger(limit, larger(sign * v0, sign * v1)));
  add((reached - sign * v0) / raise, sign * raise);
  if (top > reached) {
    add((square - reached * reached) * (Real(1) / (Real(2) * raise) + Real(1) / (Real(2) * fall)) / reached, Real(0));
  }
  add((reached - sign * v1) / fall, -sign * fall);
  if (!is_finite(state.position) || !is_finite(time_s)) {
    trajectory.segment_count = 0;
    return PlanResult::out_of_range;
  }
  trajectory.duration_s = time_s;
  trajectory.target = {target.position + frame * time_s, target.velocity, Real(0)};
  return PlanResult::ok;
}

template <typename Real>
PlanResult plan_synchronised(int axis_count, const AxisState<Real>* start, const AxisState<Real>* target, const AxisLimits<Real>* limits,
                             Trajectory<Real>* trajectories, Target how, int* failed_axis) {
  Axis<Real> axes[kMostAxes];
  AxisArrival<Real> arrivals[kMostAxes];
  axis_count = clamped(axis_count, 0, kMostAxes);
  Real duration_s = 0;
  for (int i = 0; i < axis_count; ++i) {
    if (const PlanResult result = pose_axis(start[i], target[i], limits[i], how, axes[i]); result != PlanResult::ok) {
      if (failed_axis != nullptr) {
        *failed_axis = i;
      }
      return result;
    }
    arrive_first(axes[i], arrivals[i]);
    duration_s = larger(duration_s, arrivals[i].duration_s);
  }
  // An axis that cannot arrive in this time puts the arrival off for all. Each has only a few spans of time without arrival.
  constexpr int kMostDelays = 8 * kMostAxes;
  for (int delay = 0, agreed = 0; agreed < axis_count && delay < kMostDelays; ++delay) {
    for (agreed = 0; agreed < axis_count; ++agreed) {
      AxisArrival<Real>& arrival = arrivals[agreed];
      if (arrival.duration_s != duration_s) {
        arrive_from(axes[agreed], duration_s, arrival);
        if (arrival.duration_s > duration_s) {
          duration_s = arrival.duration_s;
          break;
        }
      }
    }
  }
  for (int i = 0; i < axis_count; ++i) {
    Way<Real> way;
    append_arrival(axes[i], arrivals[i], way);
    if (const PlanResult result = finish(way, start[i], target[i], limits[i], how, trajectories[i]); result != PlanResult::ok) {
      if (failed_axis != nullptr) {
        *failed_axis = i;
      }
      return result;
    }
    if (how == Target::moving_on) {
      trajectories[i].target.position = target[i].position + target[i].velocity * duration_s;
    }
    trajectories[i].duration_s = duration_s;
  }
  return PlanResult::ok;
}

template <typename Real>
PlanResult plan_plane(const AxisState<Real> (&start)[3], const AxisState<Real> (&target)[3], const PlaneLimits<Real>& plane,
                      const AxisLimits<Real>& yaw, Trajectory<Real> (&trajectories)[3], Target how) {
  if (!is_whole(start[0]) || !is_whole(start[1]) || !is_whole(target[0]) || !is_whole(target[1]) || !is_finite(plane.speed_max) ||
      !is_finite(plane.acceleration_max) || !is_finite(plane.jerk_max)) {
    return PlanResult::not_finite;
  }
  if (!(plane.speed_max > Real(0) && plane.acceleration_max > Real(0) && plane.jerk_max > Real(0))) {
    return PlanResult::limit_without_room;
  }
  // The split is told by the tangent of its half, t: cos = (1 - t^2)/(1 + t^2), sin = 2 t/(1 + t^2); 0 < t < 1.
  constexpr Real kLeast = Real(1) / Real(2048);
  const auto share = [](Real t, int axis) { return (axis == 0 ? Real(1) - t * t : Real(2) * t) / (Real(1) + t * t); };
  Real low = kLeast;
  Real high = Real(1) - kLeast;
  const auto leave_room = [&](Real x, Real y) {
    // Half of the angle whose cosine is x, and whose sine is y.
    high = smaller(high, square_root((Real(1) - absolute(x)) / (Real(1) + absolute(x))));
    low = larger(low, absolute(y) / (Real(1) + square_root(Real(1) - y * y)));
  };
  const auto length_is_beyond = [](Real x, Real y, Real most) {
    return !((x / most) * (x / most) + (y / most) * (y / most) <= Real(1) + kLimitTolerance<Real>);
  };
  if (length_is_beyond(target[0].velocity, target[1].velocity, plane.speed_max)) {
    return PlanResult::target_velocity_beyond_limit;
  }
  leave_room(target[0].velocity / plane.speed_max, target[1].velocity / plane.speed_max);
  if (!(low <= high)) {
    return PlanResult::target_velocity_beyond_limit;
  }
  if (how == Target::at_position) {
    leave_room(target[0].acceleration / plane.acceleration_max, target[1].acceleration / plane.acceleration_max);
    if (!(low <= high)) {
      return PlanResult::target_acceleration_beyond_limit;
    }
  }
  const auto limits_of = [&](Real t, int axis) {
    const Real part = share(t, axis);
    return AxisLimits<Real>::symmetric(part * plane.speed_max, part * plane.acceleration_max, part * plane.jerk_max);
  };
  // More of everything makes an axis faster: the two durations cross once. An axis that cannot do with its part needs more.
  const auto duration_of_axis = [&](Real t, int axis) {
    Axis<Real> posed;
    if (pose_axis(start[axis], target[axis], limits_of(t, axis), how, posed) != PlanResult::ok) {
      return std::numeric_limits<Real>::max();
    }
    AxisArrival<Real> arrival;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled in next
    arrive_first(posed, arrival);
    return arrival.duration_s;
  };
  constexpr int kHalvings = std::numeric_limits<Real>::digits > 32 ? 24 : 16;
  for (int i = 0; i < kHalvings; ++i) {
    const Real middle = (low + high) / Real(2);
    (duration_of_axis(middle, 0) > duration_of_axis(middle, 1) ? high : low) = middle;
  }
  const Real t = (low + high) / Real(2);
  const AxisLimits<Real> limits[3] = {limits_of(t, 0), limits_of(t, 1), yaw};
  return plan_synchronised(3, start, target, limits, trajectories, how);
}

#define ROBOT_CORE_INSTANTIATE(Real)                                                                                                      \
  template PlanResult plan_position(const AxisState<Real>&, const AxisState<Real>&, const AxisLimits<Real>&, Trajectory<Real>&, Target);  \
  template PlanResult plan_velocity(const AxisState<Real>&, const AxisState<Real>&, const AxisLimits<Real>&, Trajectory<Real>&);          \
  template PlanResult plan_bang_bang(const AxisState<Real>&, const AxisState<Real>&, const AxisLimits<Real>&, Trajectory<Real>&, Target); \
  template PlanResult plan_synchronised(int, const AxisState<Real>*, const AxisState<Real>*, const AxisLimits<Real>*, Trajectory<Real>*,  \
                                        Target, int*);                                                                                    \
  template PlanResult plan_plane(const AxisState<Real>(&)[3], const AxisState<Real>(&)[3], const PlaneLimits<Real>&,                      \
                                 const AxisLimits<Real>&, Trajectory<Real>(&)[3], Target)

ROBOT_CORE_INSTANTIATE(float);
#ifndef ROBOT_CORE_WITHOUT_DOUBLE
ROBOT_CORE_INSTANTIATE(double);
#endif

}  // namespace robot_core
