// Finds the first widest motion that covers the required distance; see trajectory_ascent.h.
#pragma once

#include <limits>

#include "robot_core/math.h"
#include "robot_core/trajectory_ascent.h"
#include "robot_core/trajectory_limits.h"
#include "robot_core/trajectory_root.h"

namespace robot_core::detail {

/// Solves for the duration s of the fall, with neither leg held.
template <typename Real>
inline Shape<Real> solve_free(const Ascent<Real>& a, Real low_s, Real high_s, Real guess) {
  const Real quarter_rise_2 = a.rise * a.rise / Real(4);
  const auto function = [&](Real s) {
    const Real inverse = Real(1) / s;
    const Real pull = quarter_rise_2 * inverse;
    const Real s_2 = s * s;
    return Jet<Real>{s * (s_2 / Real(4) + a.sum) - pull - a.goal, s * (s_2 / Real(4) + absolute(a.sum)) + pull + absolute(a.goal),
                     Real(3) / Real(4) * s_2 + a.sum + pull * inverse, Real(3) / Real(2) * s - Real(2) * pull * inverse * inverse};
  };
  return free_shape(a, root_between(function, low_s, high_s, guess, Real(0)), a.goal);
}

/// Solves for the slope of the other leg, with one leg held at `bound`. `rise` is the other vertex minus the vertex of the held leg.
template <typename Real>
inline Real solve_held(Real bound, Real vertex, Real sum, Real rise, Real goal, Real low, Real high, Real guess) {
  const Real inverse = Real(1) / bound;
  const Real rest = sum / Real(2) * (bound + rise * inverse);
  const Real offset = rest - goal;
  const Real offset_magnitude = absolute(rest) + absolute(goal);
  const auto function = [&](Real y) {
    const Real y_2 = y * y;
    const Real speed = vertex + y_2 + bound * y / Real(2);
    const Real segment = Real(1) + y * inverse;
    const Real curve = y * ((vertex + y_2 / Real(2)) * inverse + bound / Real(2) + y);
    return Jet<Real>{y * (Real(2) * vertex + curve) + offset,
                     absolute(y) * (Real(2) * absolute(vertex) + absolute(curve)) + offset_magnitude, Real(2) * speed * segment,
                     Real(2) * ((Real(2) * y + bound / Real(2)) * segment + speed * inverse)};
  };
  return root_between(function, low, high, guess, bound);
}

/// Solves for the height of the high leg at which the goal is met, with both legs held.
template <typename Real>
inline Real solve_both_held(const Ascent<Real>& a) {
  const Real inverse = Real(1) / a.low.bound + Real(1) / a.high.bound;
  const Real linear = a.high.vertex * inverse + (a.low.bound + a.high.bound) / Real(2);
  const Real rest = a.sum / Real(2) * (a.low.bound + a.rise / a.low.bound) + a.high.vertex * a.high.bound - a.goal;
  const Real root = square_root(linear * linear - Real(2) * inverse * rest);
  return linear > Real(0) ? -Real(2) * rest / (linear + root) : (root - linear) / inverse;
}

/// Finds the motion with a top above `from` that meets the goal, for distance(from) <= goal < distance(ceiling). Calculates with heights
/// instead of the top: a short motion at a high velocity hardly raises it.
template <typename Real>
inline Shape<Real> solve_top(const Ascent<Real>& a, const Place<Real>& from, const Place<Real>& ceiling) {
  Place<Real> low = from;
  Place<Real> high = ceiling;
  // Above its threshold height a leg is held; compare the goal with the distance at that height.
  const auto narrow = [&](Real high_height) {
    if (high_height <= low.high_height) {
      return true;
    }
    if (high_height >= high.high_height) {
      return false;
    }
    const Place<Real> place = top_place(a, a.high.vertex + high_height, high_height + a.rise, high_height);
    const bool is_held = place.distance <= a.goal;
    (is_held ? low : high) = place;
    return is_held;
  };
  const bool low_is_held = narrow(a.low.bound * a.low.bound - a.rise);
  const bool high_is_held = narrow(a.high.bound * a.high.bound);
  if (low_is_held && high_is_held) {
    const Real height = clamped(solve_both_held(a), low.high_height, high.high_height);
    return top_shape(a, top_place(a, a.high.vertex + height, height + a.rise, height), Real(0), a.goal);
  }
  const Real share = clamped((a.goal - low.distance) / (high.distance - low.distance), Real(0), Real(1));
  const Real y_low = square_root(low.high_height);
  const Real y_high = square_root(high.high_height);
  if (low_is_held) {
    const Real y = solve_held(a.low.bound, a.high.vertex, a.sum, a.rise, a.goal, y_low, y_high, y_low + share * (y_high - y_low));
    return low_held_shape(a, y, a.goal);
  }
  const Real x_low = square_root(low.low_height);
  const Real x_high = square_root(high.low_height);
  if (high_is_held) {
    const Real x = solve_held(a.high.bound, a.low.vertex, a.sum, -a.rise, a.goal, x_low, x_high, x_low + share * (x_high - x_low));
    return high_held_shape(a, x, a.goal);
  }
  const Real s_low = x_low + y_low;
  const Real s_high = x_high + y_high;
  // The legs' own velocities shift the root of the pure cubic up or down.
  Real guess = s_low + share * (s_high - s_low);
  const Real linear = a.sum - a.rise / Real(4);
  const Real cubic = rough_cube_root(Real(4) * larger(a.goal, Real(0)));
  const Real bound = linear > Real(0) ? cubic : cubic + Real(2) * square_root(-linear);
  guess = larger(smaller(guess, bound), larger(s_low, s_high * std::numeric_limits<Real>::epsilon()));
  return solve_free(a, s_low, s_high, guess);
}

/// Finds the saddle between y = low and y = high that meets the goal. The low leg must be held at both or at neither.
template <typename Real>
inline Shape<Real> solve_saddle(const Ascent<Real>& a, Real low, Real high, Real low_distance, Real high_distance) {
  const Real share = clamped((a.goal - low_distance) / (high_distance - low_distance), Real(0), Real(1));
  if (saddle_is_held(a, (low + high) / Real(2))) {
    const Real y = solve_held(a.low.bound, a.high.vertex, a.sum, a.rise, a.goal, low, high, low + share * (high - low));
    return low_held_shape(a, y, a.goal);
  }
  const Real s_low = a.rise / (square_root(a.rise + low * low) - low);
  const Real s_high = a.rise / (square_root(a.rise + high * high) - high);
  return solve_free(a, s_low, s_high, s_low + share * (s_high - s_low));
}

/// Returns the y of the saddle at which the distance stops growing with T, or `otherwise` if it does not stop.
template <typename Real>
inline Real saddle_crest(const Ascent<Real>& a, Real from, Real otherwise) {
  const Real bound = a.low.bound;
  if (saddle_is_held(a, from)) {
    const Real square = bound * bound / Real(16) - a.high.vertex;
    if (square > Real(0)) {
      const Real y = -bound / Real(4) - square_root(square);
      if (y > from && saddle_is_held(a, y)) {
        return smaller(y, otherwise);
      }
    }
  }
  const Real square = a.sum * a.sum - Real(3) / Real(4) * a.rise * a.rise;
  if (a.sum < Real(0) && square > Real(0) && a.rise > Real(0)) {
    // The smaller root of 3 s^4 + 4 W s^2 + K^2, in the form without cancellation.
    const Real s = a.rise / square_root(Real(2) * (square_root(square) - a.sum));
    const Real y = (s - a.rise / s) / Real(2);
    if (y > from && y < otherwise && !saddle_is_held(a, y)) {
      return y;
    }
  }
  return otherwise;
}

/// Returns d(distance)/dT of a saddle.
template <typename Real>
inline Real saddle_speed(const Ascent<Real>& a, Real y) {
  const Real x = smaller(a.low.bound, square_root(a.rise + y * y));
  return a.high.vertex + y * (y + x / Real(2));
}

/// Searches one part of the saddles, with a distance not above the goal at its start. Returns true if the goal is met in it.
template <typename Real>
inline bool meet_in_saddle(const Ascent<Real>& a, Place<Real>& from, Real until, Shape<Real>& shape) {
  if (!(until > from.at)) {
    return false;
  }
  const Real reach = a.low.bound * a.low.bound - a.rise;
  if (saddle_is_held(a, from.at) && !saddle_is_held(a, until)) {
    const Real release = clamped(-square_root(reach), from.at, until);
    const Real distance = held_distance(a.low.bound, a.high.vertex, a.sum, a.rise, release);
    if (distance >= a.goal) {
      const Real share = clamped((a.goal - from.distance) / (distance - from.distance), Real(0), Real(1));
      const Real y = solve_held(a.low.bound, a.high.vertex, a.sum, a.rise, a.goal, from.at, release, from.at + share * (release - from.at));
      shape = low_held_shape(a, y, a.goal);
      return true;
    }
    from = saddle_place(release, distance);
    const Real end = saddle_distance(a, until);
    if (end >= a.goal && until > release && a.rise > Real(0)) {
      const Real s_low = a.rise / (a.low.bound - release);
      const Real s_high = a.rise / (square_root(a.rise + until * until) - until);
      shape = solve_free(a, s_low, s_high, s_low + clamped((a.goal - distance) / (end - distance), Real(0), Real(1)) * (s_high - s_low));
      return true;
    }
    from = saddle_place(until, end);
    return false;
  }
  const Real end = saddle_distance(a, until);
  if (end >= a.goal && a.rise > Real(0)) {
    shape = solve_saddle(a, from.at, until, from.distance, end);
    return true;
  }
  from = saddle_place(until, end);
  return false;
}

/// Returns the distance that a motion misses from end to end. From vertex to vertex the error is not visible: short motions between large
/// accelerations are far shorter than that. `scale` is the reference for rounding errors.
template <typename Real>
inline Real missed_distance(const Ascent<Real>& a, const Shape<Real>& shape, Real& scale) {
  Real distance = 0;
  Real duration = 0;
  Real velocity = 0;
  const auto go = [&](Real from, Real slope, Real jerk, Real time) {
    distance += time * (from + time * (slope / Real(2) + time * jerk / Real(6)));
    duration += time;
    velocity = larger(velocity, absolute(from));
    return from + time * (slope + time * jerk / Real(2));
  };
  const auto raise = [&](const Leg<Real>& leg, Real slope, Real hold) {
    const Real reached = go(leg.vertex + leg.entry * leg.entry / Real(2), leg.entry, Real(1), larger(slope - leg.entry, Real(0)));
    return go(reached, slope, Real(0), hold);
  };
  raise(a.high, shape.slope_high, shape.hold_high);
  go(raise(a.low, shape.slope_low, shape.hold_low), shape.slope_low, Real(-1), shape.fall);
  const Real slope = absolute(shape.slope_low) + absolute(shape.slope_high);
  scale = a.position_scale + duration * (velocity + duration * slope);
  return a.distance - distance;
}

/// Returns true if the motion at a place meets the goal within rounding.
template <typename Real>
inline bool is_met(const Ascent<Real>& a, const Place<Real>& place) {
  if (absolute(a.goal - place.distance) > kTouch<Real> * (a.goal_scale + absolute(place.distance))) {
    return false;
  }
  Real scale = 0;
  const Real missed = missed_distance(a, shape_at(a, place), scale);
  return absolute(missed) <= kTouch<Real> * scale;
}

/// Accepts a motion that meets the goal within rounding. Otherwise, if the next arrival comes much later, a plan made on the way would take
/// a detour.
template <typename Real>
inline bool touch(const Ascent<Real>& a, const Place<Real>& place, Shape<Real>& shape) {
  const bool meets = is_met(a, place);
  if (meets) {
    shape = shape_at(a, place);
  }
  return meets;
}

/// Finds a motion that one leg enters with its fall, while the other is raised to a slope (of the given sign) or held. These are the
/// shortest motion and those at both ends of the gap. Each is the only one of its duration, and the next arrival may come much later. The
/// velocities alone give the slope, but their rounding errors enter it, and the distance, 1/slope times. So the distance gives the slope
/// (or the hold), and the velocities must agree within rounding. Returns false also if ordinary motions exist there.
template <typename Real>
inline bool meet_at_edge(const Ascent<Real>& a, bool low_is_free, Real sign, Shape<Real>& shape) {
  const Leg<Real>& fixed = low_is_free ? a.high : a.low;
  const Leg<Real>& free = low_is_free ? a.low : a.high;
  const Real entry_2 = fixed.entry * fixed.entry;
  const Real square = low_is_free ? entry_2 + a.rise : entry_2 - a.rise;
  const Real tolerance = kTouch<Real> * (absolute(a.low.vertex) + absolute(a.high.vertex) + entry_2);
  const bool is_held = sign > Real(0) && square > free.bound * free.bound;
  Real slope = is_held ? free.bound : sign * square_root(square);
  Real hold = is_held ? square / free.bound - free.bound : Real(0);
  Real missed = 0;
  Real scale = 0;
  constexpr int kSteps = 3;
  for (int step = 0; step < kSteps; ++step) {
    const Real fall = fixed.entry + slope;
    shape = low_is_free ? Shape<Real>{slope, hold, fixed.entry, Real(0), fall, Real(0), a.goal}
                        : Shape<Real>{fixed.entry, Real(0), slope, hold, fall, Real(0), a.goal};
    missed = missed_distance(a, shape, scale);
    const Real later = missed / (fixed.vertex + entry_2 - slope * slope / Real(2));
    (is_held ? hold : slope) += is_held ? later : later / Real(2);
    if (!(absolute(square - slope * (slope + hold)) <= tolerance) || (step == 0 && later * sign > Real(0))) {
      return false;
    }
  }
  // At a large velocity that test accepts any slope, so check the limits as well.
  return shape.fall >= Real(0) && hold >= Real(0) && slope > free.entry &&
         slope <= free.bound * (Real(1) + kLimitTolerance<Real>)&&absolute(missed) <= kTouch<Real> * scale;
}

/// Finds the shortest motion, if it meets the goal within rounding and slightly longer ones cover less distance.
template <typename Real>
inline bool meet_at_shortest(const Ascent<Real>& a, const Place<Real>& place, Shape<Real>& shape) {
  const Real entry_2 = a.high.entry * a.high.entry;
  const bool falls_behind = (place.is_saddle ? a.high.vertex + entry_2 : place.at) < Real(0);
  return falls_behind && meet_at_edge(a, place.is_saddle || entry_2 >= place.high_height, Real(1), shape);
}

/// Finds the first motion from `from` on that meets the goal; the distance at `from` must not be above it. False if a gap comes first.
template <typename Real>
inline bool meet(const Ascent<Real>& a, Place<Real> from, Shape<Real>& shape) {
  if (from.is_saddle) {
    const Real until = a.gap;
    if (saddle_speed(a, from.at) > Real(0)) {
      const Real crest = saddle_crest(a, from.at, until);
      if (crest < until && (meet_in_saddle(a, from, crest, shape) || touch(a, from, shape))) {
        return true;
      }
    }
    if (meet_in_saddle(a, from, until, shape)) {
      return true;
    }
    if (a.has_gap) {
      return touch(a, from, shape);
    }
    from = top_place(a, a.high.vertex, a.rise, Real(0));
  }
  const Place<Real> ceiling = top_place(a, a.ceiling);
  if (a.goal >= ceiling.distance) {
    shape = top_shape(a, ceiling, (a.goal - ceiling.distance) / a.ceiling, a.goal);
    return true;
  }
  if (a.goal <= from.distance) {
    shape = shape_at(a, from);
    return true;
  }
  shape = solve_top(a, from, ceiling);
  return true;
}

}  // namespace robot_core::detail
