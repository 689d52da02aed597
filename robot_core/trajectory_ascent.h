// The widest motion of a given duration, and the durations at which it covers a given distance. Part of the trajectory planner. The unit of
// jerk is the axis' jerk_max, so accelerations are in s, velocities in s2, distances in s3.
//
// Consider all motions of duration T from (v0, a0) to (v1, a1) that keep the limits. One of them has the highest velocity at every moment,
// hence the largest distance: the widest motion. Its phases are raise, hold, fall, [cruise,] fall, hold, raise. Proof: two parabolas of
// jerk +1 bound the velocity from both ends. A parabola of jerk -1 that touches both cannot be exceeded: the difference of a faster motion
// would be convex and not above zero at its ends. The lowest motion is the same with all signs reversed. Motions of equal T may be blended,
// because all limits are convex. A target is therefore reachable in T exactly if its distance lies between the lowest and the widest
// motion. The earliest arrival is the first T at which one of the two covers the distance.
//
// A widest motion has two legs, which are alike when one is read backwards. A leg begins with the slope `entry` of the velocity, raises it
// to `slope`, holds it if that is the `bound`, and falls to the top. Extended backwards, its parabola has a vertex of velocity `vertex`.
// With distances counted from vertex to vertex, the entries vanish from all formulas.
//   free (nothing held):  x^2 - y^2 = K,  s = x + y,  T = 2 s,  distance = s^3/4 + W s - K^2/(4 s)
// Here x and y are the slopes of the legs with the lower and higher vertex; K and W are the difference and sum of the vertices. y < 0 is a
// saddle: the acceleration does not change its sign between the legs. Otherwise there is a top of velocity u:
//   a leg of height z = u - vertex lasts 2 sqrt(z), or B + z/B beyond z = B^2, at a mean velocity of (u + vertex)/2.
// In both cases d(distance)/dT = u + x y/2 with u = (higher vertex) + y^2. With growing T it first falls, then rises.
#pragma once

#include <limits>

#include "robot_core/math.h"

namespace robot_core::detail {

/// Relative rounding error of a few operations.
template <typename Real>
inline constexpr Real kRounding = Real(128) * std::numeric_limits<Real>::epsilon();

template <typename Real>
struct Leg {
  Real vertex;
  Real entry;
  Real bound;
};

/// Properties of the upward motions between two ends.
template <typename Real>
struct Ascent {
  Leg<Real> low;
  Leg<Real> high;
  bool low_is_start;
  Real rise;     ///< K, difference of the vertices, >= 0
  Real sum;      ///< W, sum of the vertices
  Real ceiling;  ///< velocity of the highest top
  Real goal;     ///< required distance from vertex to vertex
  Real goal_scale;
  Real distance;        ///< required distance from end to end
  Real position_scale;  ///< magnitude of the positions whose difference is `distance`
  bool starts_in_saddle;
  /// Saddles exist from the shortest one up to y = gap. For longer durations no motion exists until the low leg starts at its entry.
  bool has_gap;
  Real gap;
  Real entries;  ///< duration from vertex to vertex minus duration of the motion
};

/// Phases of one widest motion.
template <typename Real>
struct Shape {
  Real slope_low;
  Real hold_low;
  Real slope_high;
  Real hold_high;
  Real fall;    ///< duration of both falls together
  Real cruise;  ///< duration of the cruise between the falls
  Real distance;
};

/// Member of the family of widest motions: the top u, or the saddle's y < 0.
template <typename Real>
struct Place {
  bool is_saddle;
  Real at;
  Real distance;
  Real low_height;  ///< leg heights, only for a top
  Real high_height;
};

template <typename Real>
inline Real leg_duration(Real height, Real bound) {
  return height < bound * bound ? Real(2) * square_root(height) : bound + height / bound;
}

template <typename Real>
inline Place<Real> top_place(const Ascent<Real>& a, Real top, Real low_height, Real high_height) {
  const Real distance = (top + a.low.vertex) / Real(2) * leg_duration(low_height, a.low.bound) +
                        (top + a.high.vertex) / Real(2) * leg_duration(high_height, a.high.bound);
  return {false, top, distance, low_height, high_height};
}

/// Lowest height of a leg: the square of its entry, even if that is lost to rounding beside the velocities.
template <typename Real>
inline Real least_height(const Leg<Real>& leg) {
  return leg.entry > Real(0) ? leg.entry * leg.entry : Real(0);
}

template <typename Real>
inline Place<Real> top_place(const Ascent<Real>& a, Real top) {
  return top_place(a, top, larger(top - a.low.vertex, least_height(a.low)), larger(top - a.high.vertex, least_height(a.high)));
}

template <typename Real>
inline Real top_duration(const Ascent<Real>& a, const Place<Real>& place) {
  return leg_duration(place.low_height, a.low.bound) + leg_duration(place.high_height, a.high.bound);
}

template <typename Real>
inline Place<Real> saddle_place(Real y, Real distance) {
  return {true, y, distance, Real(0), Real(0)};
}

template <typename Real>
inline bool saddle_is_held(const Ascent<Real>& a, Real y) {
  return a.rise + y * y > a.low.bound * a.low.bound;
}

template <typename Real>
inline Real saddle_duration(const Ascent<Real>& a, Real y) {
  if (saddle_is_held(a, y)) {
    return Real(2) * y + (y * y + a.rise) / a.low.bound + a.low.bound;
  }
  return a.rise > Real(0) ? Real(2) * a.rise / (square_root(a.rise + y * y) - y) : Real(0);
}

template <typename Real>
inline Real held_distance(Real held_bound, Real other_vertex, Real sum, Real rise, Real y) {
  return y * (Real(2) * other_vertex + y * ((other_vertex + y * y / Real(2)) / held_bound + held_bound / Real(2) + y)) +
         sum / Real(2) * (held_bound + rise / held_bound);
}

template <typename Real>
inline Real saddle_distance(const Ascent<Real>& a, Real y) {
  if (saddle_is_held(a, y)) {
    return held_distance(a.low.bound, a.high.vertex, a.sum, a.rise, y);
  }
  if (!(a.rise > Real(0))) {
    return Real(0);
  }
  const Real difference = square_root(a.rise + y * y) - y;
  const Real s = a.rise / difference;
  return s * (s * s / Real(4) + a.sum) - a.rise * difference / Real(4);
}

/// `up_difference`: vertex of the end minus vertex of the start. `down_difference`: the same for the mirrored motion.
template <typename Real>
inline Ascent<Real> make_ascent(const Leg<Real>& start, const Leg<Real>& end, Real up_difference, Real down_difference, Real velocity_max,
                                Real distance, Real position_scale) {
  Ascent<Real> a{};
  a.low_is_start = up_difference > Real(0) || (up_difference == Real(0) && !(start.entry < Real(0)));
  a.low = a.low_is_start ? start : end;
  a.high = a.low_is_start ? end : start;
  a.rise = absolute(up_difference);
  a.sum = start.vertex + end.vertex;
  a.entries = start.entry + end.entry;
  const Real start_part = start.entry * (start.vertex + start.entry * start.entry / Real(6));
  const Real end_part = end.entry * (end.vertex + end.entry * end.entry / Real(6));
  a.goal = distance + start_part + end_part;
  a.distance = distance;
  a.position_scale = position_scale;
  a.goal_scale = position_scale + absolute(start.entry) * (absolute(start.vertex) + start.entry * start.entry) +
                 absolute(end.entry) * (absolute(end.vertex) + end.entry * end.entry);
  const bool entry_fits = !(a.low.entry > Real(0)) || (a.low_is_start ? down_difference <= Real(0) : down_difference >= Real(0));
  a.starts_in_saddle = a.high.entry < Real(0) && entry_fits;
  const Real missing = a.low.entry * a.low.entry - a.rise;
  a.has_gap = a.starts_in_saddle && a.low.entry > Real(0) && missing > Real(0);
  a.gap = a.has_gap ? larger(-square_root(missing), a.high.entry) : Real(0);
  // Counts the excess of an end over the limit, but not its rounding error, which a slow cruise would take for its velocity.
  const auto beyond = [velocity_max](const Leg<Real>& leg) {
    const Real least = least_height(leg);
    const Real rounding = Real(4) * std::numeric_limits<Real>::epsilon() * (absolute(leg.vertex) + least);
    return leg.vertex + least > velocity_max + rounding ? leg.vertex + least : velocity_max;
  };
  a.ceiling = larger(beyond(a.low), beyond(a.high));
  return a;
}

/// Returns the lowest top with complete legs: one of them begins with a fall or, if none can, at its vertex.
template <typename Real>
inline Place<Real> lowest_top(const Ascent<Real>& a) {
  const Real low = least_height(a.low);
  const Real high = least_height(a.high);
  if (low - a.rise > high) {
    return top_place(a, a.low.vertex + low, low, low - a.rise);
  }
  return top_place(a, a.high.vertex + high, a.rise + high, high);
}

/// Returns the motion with the shortest duration of all.
template <typename Real>
inline Place<Real> shortest(const Ascent<Real>& a) {
  return a.starts_in_saddle ? saddle_place(a.high.entry, saddle_distance(a, a.high.entry)) : lowest_top(a);
}

template <typename Real>
inline void set_leg(Real height, Real bound, Real& slope, Real& hold) {
  if (height < bound * bound) {
    slope = square_root(height);
    hold = Real(0);
  } else {
    slope = bound;
    hold = height / bound - bound;
  }
}

template <typename Real>
inline Shape<Real> top_shape(const Ascent<Real>& a, const Place<Real>& place, Real cruise, Real distance) {
  Shape<Real> shape{};
  set_leg(place.low_height, a.low.bound, shape.slope_low, shape.hold_low);
  set_leg(place.high_height, a.high.bound, shape.slope_high, shape.hold_high);
  shape.fall = shape.slope_low + shape.slope_high;
  shape.cruise = cruise;
  shape.distance = distance;
  return shape;
}

template <typename Real>
inline Shape<Real> free_shape(const Ascent<Real>& a, Real s, Real distance) {
  const Real difference = s > Real(0) ? a.rise / s : -Real(2) * a.high.entry;
  const Real x = (s + difference) / Real(2);
  const Real y = (s - difference) / Real(2);
  return {x, Real(0), y, Real(0), s, Real(0), distance};
}

/// Shape with the low leg held and the slope y of the high leg.
template <typename Real>
inline Shape<Real> low_held_shape(const Ascent<Real>& a, Real y, Real distance) {
  const Real bound = a.low.bound;
  return {bound, larger((a.rise + y * y) / bound - bound, Real(0)), y, Real(0), bound + y, Real(0), distance};
}

/// Shape with the high leg held and the slope x of the low leg.
template <typename Real>
inline Shape<Real> high_held_shape(const Ascent<Real>& a, Real x, Real distance) {
  const Real bound = a.high.bound;
  return {x, Real(0), bound, larger((x * x - a.rise) / bound - bound, Real(0)), x + bound, Real(0), distance};
}

template <typename Real>
inline Shape<Real> shape_at(const Ascent<Real>& a, const Place<Real>& place) {
  if (!place.is_saddle) {
    return top_shape(a, place, Real(0), place.distance);
  }
  if (saddle_is_held(a, place.at)) {
    return low_held_shape(a, place.at, place.distance);
  }
  const Real x = square_root(a.rise + place.at * place.at);
  const Real s = a.rise > Real(0) ? a.rise / (x - place.at) : Real(0);
  return {x, Real(0), place.at, Real(0), s, Real(0), place.distance};
}

/// Returns the widest motion of a duration (from vertex to vertex); sets `place` to its place in the family.
template <typename Real>
inline Shape<Real> at_duration(const Ascent<Real>& a, Real duration, Place<Real>& place) {
  const Real s = duration / Real(2);
  const Real difference = s > Real(0) ? a.rise / s : Real(0);
  Real x = (s + difference) / Real(2);
  Real y = (s - difference) / Real(2);
  bool low_is_held = false;
  bool high_is_held = false;
  const bool is_saddle = duration < leg_duration(a.rise, a.low.bound);
  if (is_saddle) {
    low_is_held = x > a.low.bound;
    y = low_is_held ? square_root(a.low.bound * duration - a.rise) - a.low.bound : y;
  } else {
    const Place<Real> ceiling = top_place(a, a.ceiling);
    if (const Real cruise = duration - top_duration(a, ceiling); cruise >= Real(0)) {
      place = ceiling;
      place.distance += cruise * a.ceiling;
      return top_shape(a, ceiling, cruise, place.distance);
    }
    if (x > a.low.bound || y > a.high.bound) {
      const Real held_y = square_root(a.low.bound * duration - a.rise) - a.low.bound;
      const Real held_x = square_root(a.high.bound * duration + a.rise) - a.high.bound;
      low_is_held = held_x > a.low.bound || (x > a.low.bound && held_y <= a.high.bound);
      high_is_held = !low_is_held || held_y > a.high.bound;
      x = held_x;
      y = held_y;
    }
    if (low_is_held && high_is_held) {
      const Real over_low = Real(1) / a.low.bound;
      const Real over_high = Real(1) / a.high.bound;
      const Real top =
          (duration - a.low.bound - a.high.bound + a.low.vertex * over_low + a.high.vertex * over_high) / (over_low + over_high);
      place = top_place(a, smaller(larger(top, a.high.vertex), a.ceiling));
      return top_shape(a, place, Real(0), place.distance);
    }
  }
  // Do not calculate this from the top: a short motion at a high velocity hardly raises it.
  Shape<Real> shape{};
  if (low_is_held) {
    shape = low_held_shape(a, y, held_distance(a.low.bound, a.high.vertex, a.sum, a.rise, y));
  } else if (high_is_held) {
    shape = high_held_shape(a, x, held_distance(a.high.bound, a.low.vertex, a.sum, -a.rise, x));
  } else {
    shape = {x, Real(0), y, Real(0), s, Real(0), s * (s * s / Real(4) + a.sum) - a.rise * difference / Real(4)};
  }
  if (is_saddle) {
    place = saddle_place(y, shape.distance);
  } else {
    const Real high_height = high_is_held ? larger(x * x - a.rise, Real(0)) : y * y;
    place = {false, smaller(a.high.vertex + high_height, a.ceiling), shape.distance, a.rise + high_height, high_height};
  }
  return shape;
}

}  // namespace robot_core::detail
