// Checks of a motion in the plane against the circle of speed and acceleration. Part of the trajectory planner.
#pragma once

#include "robot_core/math.h"
#include "robot_core/trajectory.h"

namespace robot_core::detail {

template <typename Real>
Real length(Real x, Real y) {
  return square_root(x * x + y * y);
}

/// Relative tolerance for a start outside the circle. It refers to the limits, so that planning again and again does not add it up.
template <typename Real>
inline constexpr Real kCircleTolerance = Real(5e-4);

/// Largest speed of a plan from inside, relative to the limit.
template <typename Real>
inline constexpr Real kPromised = Real(1) + Real(2e-3);

/// Limits of a plane, with the tolerance.
template <typename Real>
struct Circle {
  Real speed;
  Real acceleration;
  Real jerk;

  static Circle around(const PlaneLimits<Real>& plane) {
    constexpr Real kWide = Real(1) + kCircleTolerance<Real>;
    return {kWide * plane.speed_max, kWide * plane.acceleration_max, plane.jerk_max};
  }
};

/// Returns the smallest fraction of the circle with which an axis keeps its share of speed and acceleration from now on:
/// share * speed >= velocity + acceleration^2 / (2 share * jerk).
template <typename Real>
Real least_share(const AxisState<Real>& state, const Circle<Real>& circle) {
  const Real along = state.acceleration < Real(0) ? -state.velocity : state.velocity;
  const Real square = state.acceleration * state.acceleration / circle.jerk;
  const Real braked = (along + square_root(along * along + Real(2) * circle.speed * square)) / (Real(2) * circle.speed);
  return larger(larger(absolute(state.velocity) / circle.speed, absolute(state.acceleration) / circle.acceleration), braked);
}

/// Returns the speed after the acceleration has been brought to zero along its own direction. The velocity follows a straight line until
/// then, so that the speed never exceeds the larger one at both ends.
template <typename Real>
Real braked_speed(const AxisState<Real>& x, const AxisState<Real>& y, Real jerk) {
  const Real time_s = length(x.acceleration, y.acceleration) / jerk;
  return length(x.velocity + x.acceleration * time_s / Real(2), y.velocity + y.acceleration * time_s / Real(2));
}

/// Velocity of one axis during a segment, divided by the circle's speed, as coefficients of its parabola in Bernstein form.
template <typename Real>
struct Parabola {
  Real from, corner, to;
};

/// Upper bound of x^2 + y^2, at most 1e-6 above the maximum or `floor`, whichever is larger. The Bernstein coefficients of the square bound
/// it; if they are too far off, the segment is halved.
template <typename Real>
Real most_square(const Parabola<Real>& x, const Parabola<Real>& y, Real floor, int halvings) {
  constexpr Real kExact = Real(1) + Real(1e-6);
  const Real ends = larger(x.from * x.from + y.from * y.from, x.to * x.to + y.to * y.to);
  const Real first = x.from * x.corner + y.from * y.corner;
  const Real last = x.to * x.corner + y.to * y.corner;
  const Real middle = (x.from * x.to + y.from * y.to + Real(2) * (x.corner * x.corner + y.corner * y.corner)) / Real(3);
  const Real bound = larger(larger(ends, middle), larger(first, last));
  if (bound <= kExact * larger(ends, floor) || halvings == 0) {
    return bound;
  }
  const auto halved = [](const Parabola<Real>& p, Parabola<Real>& left, Parabola<Real>& right) {
    left = {p.from, (p.from + p.corner) / Real(2), (p.from + Real(2) * p.corner + p.to) / Real(4)};
    right = {left.to, (p.corner + p.to) / Real(2), p.to};
  };
  Parabola<Real> xs[2];
  Parabola<Real> ys[2];
  halved(x, xs[0], xs[1]);
  halved(y, ys[0], ys[1]);
  const Real left = most_square(xs[0], ys[0], floor, halvings - 1);
  return larger(left, most_square(xs[1], ys[1], larger(floor, left), halvings - 1));
}

/// Iterates over the time intervals in which neither x nor y changes its jerk.
template <typename Real>
class PairOfSegments {
 public:
  explicit PairOfSegments(const Trajectory<Real>* motions) : motions_(motions), until_s_(smaller(end_s(0), end_s(1))) {}

  [[nodiscard]] Real duration_s() const { return until_s_ - from_s_; }

  /// Goes to the next interval. Returns false after the last one.
  bool next() {
    const int ended = end_s(0) <= end_s(1) ? 0 : 1;
    ++at_[ended];
    from_s_ = until_s_;
    if (at_[ended] >= motions_[ended].segment_count) {
      return false;
    }
    until_s_ = larger(from_s_, smaller(end_s(0), end_s(1)));
    return true;
  }

  [[nodiscard]] AxisState<Real> state(int axis, Real passed_s) const {
    const Trajectory<Real>& motion = motions_[axis];
    if (motion.segment_count == 0) {
      return motion.at(from_s_ + passed_s);
    }
    const TrajectorySegment<Real>& segment = motion.segments[at_[axis]];
    return Trajectory<Real>::advanced(segment.start, segment.jerk, from_s_ + passed_s - segment.start_s);
  }

 private:
  [[nodiscard]] Real end_s(int axis) const {
    const Trajectory<Real>& motion = motions_[axis];
    return at_[axis] + 1 < motion.segment_count ? motion.segments[at_[axis] + 1].start_s : motion.duration_s;
  }

  const Trajectory<Real>* motions_;
  int at_[2] = {0, 0};
  Real from_s_ = 0;
  Real until_s_ = 0;
};

/// Square of the highest speed of the path relative to the circle's speed; 1 (to 1e-6) if it stays inside.
template <typename Real>
Real speed_square(const Trajectory<Real>* motions, const Circle<Real>& circle) {
  constexpr int kHalvings = 10;
  Real most = 1;
  PairOfSegments<Real> pair(motions);
  do {
    const Real time_s = pair.duration_s();
    Parabola<Real> velocity[2];
    for (int axis = 0; axis < 2; ++axis) {
      const AxisState<Real> from = pair.state(axis, Real(0));
      velocity[axis] = {from.velocity / circle.speed, (from.velocity + from.acceleration * time_s / Real(2)) / circle.speed,
                        pair.state(axis, time_s).velocity / circle.speed};
    }
    most = larger(most, most_square(velocity[0], velocity[1], most, kHalvings));
  } while (pair.next());
  return most;
}

/// Square of the highest acceleration relative to the circle's. It is linear between changes of a jerk, so it is highest at one of them.
template <typename Real>
Real acceleration_square(const Trajectory<Real>* motions, const Circle<Real>& circle) {
  Real most = 0;
  const auto look = [&](const AxisState<Real>& x, const AxisState<Real>& y) {
    most = larger(most, x.acceleration * x.acceleration + y.acceleration * y.acceleration);
  };
  PairOfSegments<Real> pair(motions);
  do {
    look(pair.state(0, Real(0)), pair.state(1, Real(0)));
    look(pair.state(0, pair.duration_s()), pair.state(1, pair.duration_s()));
  } while (pair.next());
  return most / (circle.acceleration * circle.acceleration);
}

/// Returns true if planning anew anywhere on the path can stay inside: the state keeps fractions of some split, or braking its acceleration
/// leaves at most `speed`. Samples as densely as the velocity changes, until the state keeps the fractions of the plan itself.
template <typename Real>
bool can_stay_inside(const Trajectory<Real>* motions, const Circle<Real>& circle, Real speed, Real share_x, Real share_y) {
  constexpr Real kFewest = 4;
  constexpr Real kMost = 32;
  constexpr Real kPerSpeed = 24;
  PairOfSegments<Real> pair(motions);
  do {
    const Real slope = larger(length(pair.state(0, Real(0)).acceleration, pair.state(1, Real(0)).acceleration),
                              length(pair.state(0, pair.duration_s()).acceleration, pair.state(1, pair.duration_s()).acceleration));
    const int samples = static_cast<int>(smaller(kMost, kFewest + kPerSpeed * slope * pair.duration_s() / circle.speed));
    for (int i = 0; i < samples; ++i) {
      const Real passed_s = pair.duration_s() * Real(i) / Real(samples);
      const AxisState<Real> x = pair.state(0, passed_s);
      const AxisState<Real> y = pair.state(1, passed_s);
      const Real least_x = least_share(x, circle);
      const Real least_y = least_share(y, circle);
      if (least_x <= share_x && least_y <= share_y) {
        return true;
      }
      if (least_x * least_x + least_y * least_y > Real(1) && braked_speed(x, y, circle.jerk) > speed) {
        return false;
      }
    }
  } while (pair.next());
  return true;
}

}  // namespace robot_core::detail
