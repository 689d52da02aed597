#include <limits>

#include "robot_core/trajectory.h"
#include "robot_core/trajectory_arrival.h"
#include "robot_core/trajectory_circle.h"
#include "robot_core/trajectory_lead.h"
#include "robot_core/trajectory_limits.h"

namespace robot_core {
namespace detail {
namespace {

/// Split of the circle: x gets the cosine and y the sine of an angle, given by the tangent t of half that angle; cos = (1 - t^2)/(1 + t^2),
/// sin = 2 t/(1 + t^2), 0 < t < 1.
template <typename Real>
class Split {
 public:
  explicit Split(const PlaneLimits<Real>& plane) : plane_(plane) {}

  /// Narrows the split so that x and y, fractions of their limits, fit. Returns false if no split is left.
  bool leave_room(Real x, Real y) {
    // Tangents of half the angles with cosine x and with sine y. The room keeps rounding from making a share too small.
    constexpr Real kRoom = Real(4) * std::numeric_limits<Real>::epsilon();
    const Real cosine = smaller(absolute(x) + kRoom, Real(1));
    const Real sine = smaller(absolute(y) + kRoom, Real(1));
    high_ = smaller(high_, square_root((Real(1) - cosine) / (Real(1) + cosine)));
    low_ = larger(low_, sine / (Real(1) + square_root((Real(1) - sine) * (Real(1) + sine))));
    return low_ <= high_;
  }

  /// Returns the split at which `duration_s(limits, axis)` of axes 0 and 1 is equal. Larger limits make an axis faster, so both durations
  /// cross once. An axis that cannot move with its share must return a large duration.
  template <typename Duration>
  [[nodiscard]] Real balanced(const Duration& duration_s, int halvings = std::numeric_limits<Real>::digits > 32 ? 24 : 16) const {
    Real low = low_;
    Real high = high_;
    for (int i = 0; i < halvings; ++i) {
      const Real middle = (low + high) / Real(2);
      (duration_s(limits(middle, 0), 0) > duration_s(limits(middle, 1), 1) ? high : low) = middle;
    }
    return (low + high) / Real(2);
  }

  /// Returns the split along a vector, as near as the room allows.
  [[nodiscard]] Real along(Real x, Real y) const { return near(absolute(y) / (length(x, y) + absolute(x))); }

  /// Returns the split nearest to t that the room allows.
  [[nodiscard]] Real near(Real t) const { return clamped(t, low_, high_); }

  [[nodiscard]] static Real share(Real t, int axis) { return (axis == 0 ? Real(1) - t * t : Real(2) * t) / (Real(1) + t * t); }

  [[nodiscard]] AxisLimits<Real> limits(Real t, int axis) const {
    const Real part = share(t, axis);
    return AxisLimits<Real>::symmetric(part * plane_.speed_max, part * plane_.acceleration_max, part * plane_.jerk_max);
  }

 private:
  PlaneLimits<Real> plane_;
  Real low_ = Real(1) / Real(2048);
  Real high_ = Real(1) - Real(1) / Real(2048);
};

template <typename Real>
PlanResult check_plane(const AxisState<Real> (&start)[3], const AxisState<Real> (&target)[3], const PlaneLimits<Real>& plane) {
  if (!is_whole(start[0]) || !is_whole(start[1]) || !is_whole(target[0]) || !is_whole(target[1]) || !is_finite(plane.speed_max) ||
      !is_finite(plane.acceleration_max) || !is_finite(plane.jerk_max)) {
    return PlanResult::not_finite;
  }
  const bool has_room = plane.speed_max > Real(0) && plane.acceleration_max > Real(0) && plane.jerk_max > Real(0);
  return has_room ? PlanResult::ok : PlanResult::limit_without_room;
}

template <typename Real>
bool leave_room_for_velocity(const AxisState<Real> (&target)[3], const PlaneLimits<Real>& plane, Split<Real>& split) {
  const Real x = target[0].velocity / plane.speed_max;
  const Real y = target[1].velocity / plane.speed_max;
  return x * x + y * y <= Real(1) + kLimitTolerance<Real> && split.leave_room(x, y);
}

template <typename Real>
bool leave_room_for_acceleration(const AxisState<Real> (&target)[3], const PlaneLimits<Real>& plane, Split<Real>& split) {
  return split.leave_room(target[0].acceleration / plane.acceleration_max, target[1].acceleration / plane.acceleration_max);
}

/// Best plan so far: its split and the level of its lead.
template <typename Real>
struct Candidate {
  Real split;
  int level;
  Real square;  ///< squared ratio of the highest speed to the circle's, at least 1
  Real duration_s;
};

/// Searches the shortest plan that stays inside the circle and from which planning anew also stays inside.
template <typename Real>
class Inside {
 public:
  Inside(const AxisState<Real> (&start)[3], const AxisState<Real> (&target)[3], const PlaneLimits<Real>& plane, const AxisLimits<Real>& yaw,
         Target how, const Split<Real>& room, Trajectory<Real> (&trajectories)[3])
      : start_(start),
        target_(target),
        plane_(plane),
        yaw_(yaw),
        how_(how),
        room_(room),
        trajectories_(trajectories),
        circle_(Circle<Real>::around(plane)),
        share_x_(least_share(start[0], circle_)),
        share_y_(least_share(start[1], circle_)) {
    const Real slope = length(start[0].acceleration, start[1].acceleration);
    const Real over = slope > Real(0) ? Real(1) / slope : Real(0);
    calm_ = calming(start_, plane.jerk_max, over * absolute(start[0].acceleration), over * absolute(start[1].acceleration));
    const Real shares = length(share_x_, share_y_);
    is_in_a_box_ = shares <= Real(1);
    if (is_in_a_box_ && calm_.speed > circle_.speed) {
      calm_ = calming(start_, plane.jerk_max, share_x_ / shares, share_y_ / shares);
    }
    can_stay_ = calm_.speed <= circle_.speed;
    const Real speed = length(start[0].velocity, start[1].velocity);
    const Real most_speed = kPromised<Real> * larger(larger(plane.speed_max, calm_.speed), speed);
    // A start outside the circle must not go further out.
    circle_.speed = larger(circle_.speed, speed);
    circle_.acceleration = larger(circle_.acceleration, length(start[0].acceleration, start[1].acceleration));
    const Real most = larger(most_speed / circle_.speed, Real(1));
    most_square_ = smaller(most * most, std::numeric_limits<Real>::max() / Real(2));
  }

  PlanResult search(Real fastest) {
    const PlanResult result = plan(fastest, kNoLead);
    const bool holds = result == PlanResult::ok;
    // The numbers of a slow way back from far outside may be out of range; other plans may still work.
    if (!holds && result != PlanResult::out_of_range) {
      return result;
    }
    if (holds && keeps_shares(fastest) && rounds_little()) {
      return PlanResult::ok;
    }
    constexpr Real kMost = std::numeric_limits<Real>::max();
    fastest_s_ = holds ? trajectories_[0].duration_s : kMost / Real(16);
    best_ = {fastest, kNoLead, kMost, fastest_s_};
    if (holds && consider_planned(fastest, kNoLead)) {
      return PlanResult::ok;
    }
    turn_from(fastest);
    // Leads cost time; try them only if turning the split makes the plan much longer.
    constexpr Real kLittle = Real(5) / Real(4);
    if (best_.square > Real(1) || best_.duration_s > kLittle * fastest_s_) {
      for (int level = 0; level < kLevels; ++level) {
        consider_lead(level);
      }
    }
    if (best_.square > most_square_) {
      for (Trajectory<Real>& trajectory : trajectories_) {
        trajectory.segment_count = 0;
      }
      return PlanResult::out_of_range;
    }
    return best_.split == planned_split_ && best_.level == planned_level_ ? PlanResult::ok : plan(best_.split, best_.level);
  }

 private:
  static constexpr int kNoLead = -1;
  static constexpr int kLevels = 4;

  /// Speed at the end of a lead: the remaining speed once the acceleration is zero, or a fraction of the limit.
  [[nodiscard]] Real speed_of(int level) const {
    const Real part = Real(kLevels - 1 - level) / Real(kLevels - 1) * Real(3) / Real(4);
    return level == 0 ? calm_.speed : part * plane_.speed_max;
  }

  /// A plan whose axes keep their shares stays inside, except for rounding; only single precision needs the check.
  [[nodiscard]] bool rounds_little() const {
    return std::numeric_limits<Real>::digits > 32 || speed_square(trajectories_, circle_) <= most_square_;
  }

  [[nodiscard]] bool keeps_shares(Real t) const { return share_x_ <= Split<Real>::share(t, 0) && share_y_ <= Split<Real>::share(t, 1); }

  PlanResult plan(Real t, int level) {
    planned_split_ = t;
    planned_level_ = level;
    const Split<Real> split(plane_);
    const AxisLimits<Real> limits[3] = {split.limits(t, 0), split.limits(t, 1), yaw_};
    const int leads = level == kNoLead ? 0 : 2;
    if (leads > 0) {
      lead_to(speed_of(level), start_, calm_, plane_, leads_);
    }
    return plan_together<Real>(3, start_, target_, limits, leads_, leads, trajectories_, how_, nullptr);
  }

  /// Returns true if the last plan stays inside, also when planned anew on the way, and takes no long detour. Keeps the best plan.
  bool consider_planned(Real t, int level) {
    constexpr Real kMostDetour = 8;
    const Real duration_s = trajectories_[0].duration_s;
    const bool has_lead = level != kNoLead;
    if (!has_lead && ((!can_stay_ && duration_s > kMostDetour * fastest_s_) ||
                      !can_stay_inside(trajectories_, circle_, larger(plane_.speed_max, can_stay_ ? Real(0) : calm_.speed),
                                       Split<Real>::share(t, 0), Split<Real>::share(t, 1)))) {
      return false;
    }
    if (acceleration_square(trajectories_, circle_) > Real(1) + Real(8) * std::numeric_limits<Real>::epsilon()) {
      return false;
    }
    const Real square = speed_square(trajectories_, circle_);
    // The shorter one is better of two plans that are equally far out within rounding.
    constexpr Real kAlike = Real(1e-4);
    if (square < (Real(1) - kAlike) * best_.square || (square <= (Real(1) + kAlike) * best_.square && duration_s < best_.duration_s)) {
      best_ = {t, level, square, duration_s};
    }
    return square <= Real(1);
  }

  bool consider(Real t, int level) { return plan(t, level) == PlanResult::ok && consider_planned(t, level); }

  /// Turns the split until it fits the start, no further than needed.
  void turn_from(Real fastest) {
    constexpr int kHalvings = 5;
    Split<Real> fitting = room_;
    const bool fits = is_in_a_box_ && fitting.leave_room(share_x_, share_y_);
    const AxisState<Real>& x = start_[0];
    const AxisState<Real>& y = start_[1];
    Real far = fits ? fitting.near(fastest) : room_.along(x.velocity, y.velocity);
    if (!consider(far, kNoLead) && !fits) {
      if (x.acceleration == Real(0) && y.acceleration == Real(0)) {
        return;
      }
      far = room_.along(x.acceleration, y.acceleration);
      consider(far, kNoLead);
    }
    Real near = fastest;
    for (int halving = 0; halving < kHalvings; ++halving) {
      const Real middle = (near + far) / Real(2);
      (consider(middle, kNoLead) ? far : near) = middle;
    }
  }

  void consider_lead(int level) {
    constexpr int kHalvings = 12;
    const Real speed = speed_of(level);
    if (level > 0 && !(speed < calm_.speed)) {
      return;
    }
    Lead<Real> leads[2];
    lead_to(speed, start_, calm_, plane_, leads);
    const Real over = Real(1) / larger(circle_.speed, speed);
    Split<Real> fitting = room_;
    if (!fitting.leave_room(smaller(over * absolute(leads[0].end.velocity), Real(1)),
                            smaller(over * absolute(leads[1].end.velocity), Real(1)))) {
      return;
    }
    const auto duration_s = [&](const AxisLimits<Real>& limits, int axis) {
      AxisState<Real> met = target_[axis];
      met.position += how_ == Target::moving_on ? target_[axis].velocity * leads[axis].duration_s : Real(0);
      return leads[axis].duration_s + earliest_arrival_s(leads[axis].end, met, limits, how_);
    };
    const Real t = fitting.balanced(duration_s, kHalvings);
    const bool is_inside = best_.square <= Real(1);
    if (!is_inside || larger(duration_s(fitting.limits(t, 0), 0), duration_s(fitting.limits(t, 1), 1)) < best_.duration_s) {
      consider(t, level);
    }
  }

  const AxisState<Real> (&start_)[3];
  const AxisState<Real> (&target_)[3];
  const PlaneLimits<Real>& plane_;
  const AxisLimits<Real>& yaw_;
  Target how_;
  const Split<Real>& room_;
  Trajectory<Real> (&trajectories_)[3];
  Circle<Real> circle_;
  Real share_x_;
  Real share_y_;
  Calming<Real> calm_;
  bool is_in_a_box_;
  bool can_stay_;
  Real most_square_;  ///< squared ratio of the permitted speed to the circle's
  Lead<Real> leads_[2];
  Candidate<Real> best_{};
  Real fastest_s_ = 0;
  Real planned_split_ = 0;
  int planned_level_ = kNoLead;
};

/// Plans with the fastest split. If that leaves the circle because x and y of the start do not fit it, the split turns towards the
/// start's own direction, no further than needed. A split that makes the motion very slow is rejected. `plan(t)` fills the
/// trajectories.
template <typename Real, typename Plan>
PlanResult plan_velocity_inside(const Split<Real>& split, Real fastest, const AxisState<Real> (&start)[3], const Circle<Real>& circle,
                                const Trajectory<Real> (&trajectories)[3], const Plan& plan) {
  constexpr Real kInside = Real(1) + Real(8) * std::numeric_limits<Real>::epsilon();
  constexpr int kHalvings = 6;
  if (const PlanResult result = plan(fastest); result != PlanResult::ok) {
    return result;
  }
  Real best = fastest;
  Real last = fastest;
  Real least = acceleration_square(&trajectories[0], circle);
  constexpr Real kMostDetour = 8;
  const Real longest_s = kMostDetour * trajectories[0].duration_s;
  const auto square_at = [&](Real t) {
    last = t;
    const bool gets_on = plan(t) == PlanResult::ok && trajectories[0].duration_s <= longest_s;
    const Real square = gets_on ? acceleration_square(&trajectories[0], circle) : std::numeric_limits<Real>::max();
    if (square < least || square <= kInside) {
      least = square;
      best = t;
    }
    return square;
  };
  // The direction of a tiny acceleration is noise.
  constexpr Real kNoise = Real(1) / Real(128);
  if (least > kInside && length(start[0].acceleration, start[1].acceleration) > kNoise * circle.acceleration) {
    Real near = fastest;
    Real far = split.along(start[0].acceleration, start[1].acceleration);
    const Real square_of_far = square_at(far);
    const bool is_too_far = square_of_far == std::numeric_limits<Real>::max();
    const Real enough = is_too_far ? kInside : larger(square_of_far, kInside);
    for (int halving = 0; halving < kHalvings; ++halving) {
      const Real middle = (near + far) / Real(2);
      const Real square = square_at(middle);
      (square <= enough || square == std::numeric_limits<Real>::max() ? far : near) = middle;
    }
  }
  return best == last ? PlanResult::ok : plan(best);
}

}  // namespace
}  // namespace detail

using namespace detail;

template <typename Real>
PlanResult plan_plane(const AxisState<Real> (&start)[3], const AxisState<Real> (&target)[3], const PlaneLimits<Real>& plane,
                      const AxisLimits<Real>& yaw, Trajectory<Real> (&trajectories)[3], Target how) {
  if (const PlanResult result = check_plane(start, target, plane); result != PlanResult::ok) {
    return result;
  }
  Split<Real> split(plane);
  if (!leave_room_for_velocity(target, plane, split)) {
    return PlanResult::target_velocity_beyond_limit;
  }
  if (how == Target::at_position && !leave_room_for_acceleration(target, plane, split)) {
    return PlanResult::target_acceleration_beyond_limit;
  }
  const Real fastest =
      split.balanced([&](const AxisLimits<Real>& limits, int axis) { return earliest_arrival_s(start[axis], target[axis], limits, how); });
  return Inside<Real>(start, target, plane, yaw, how, split, trajectories).search(fastest);
}

template <typename Real>
PlanResult plan_plane_velocity(const AxisState<Real> (&start)[3], const AxisState<Real> (&target)[3], const PlaneLimits<Real>& plane,
                               const AxisLimits<Real>& yaw, Trajectory<Real> (&trajectories)[3]) {
  if (const PlanResult result = check_plane(start, target, plane); result != PlanResult::ok) {
    return result;
  }
  Split<Real> split(plane);
  if (!leave_room_for_acceleration(target, plane, split)) {
    return PlanResult::target_acceleration_beyond_limit;
  }
  const Real fastest = split.balanced([&](const AxisLimits<Real>& limits, int axis) {
    return plan_velocity(start[axis], target[axis], limits, trajectories[axis]) == PlanResult::ok ? trajectories[axis].duration_s
                                                                                                  : std::numeric_limits<Real>::max();
  });
  Circle<Real> circle = Circle<Real>::around(plane);
  circle.acceleration = larger(circle.acceleration, length(start[0].acceleration, start[1].acceleration));
  return plan_velocity_inside(split, fastest, start, circle, trajectories, [&](Real t) {
    const AxisLimits<Real> limits[3] = {split.limits(t, 0), split.limits(t, 1), yaw};
    return plan_velocity_synchronised(3, start, target, limits, trajectories);
  });
}

template <typename Real>
PlanResult plan_plane_bang_bang(const AxisState<Real> (&start)[3], const AxisState<Real> (&target)[3], const PlaneLimits<Real>& plane,
                                const AxisLimits<Real>& yaw, Trajectory<Real> (&trajectories)[3], Target how) {
  if (const PlanResult result = check_plane(start, target, plane); result != PlanResult::ok) {
    return result;
  }
  Split<Real> split(plane);
  if (!leave_room_for_velocity(target, plane, split)) {
    return PlanResult::target_velocity_beyond_limit;
  }
  const Real fastest = split.balanced([&](const AxisLimits<Real>& limits, int axis) {
    return plan_bang_bang(start[axis], target[axis], limits, trajectories[axis], how) == PlanResult::ok ? trajectories[axis].duration_s
                                                                                                        : std::numeric_limits<Real>::max();
  });
  PlanResult result = PlanResult::ok;
  for (int axis = 0; axis < 3 && result == PlanResult::ok; ++axis) {
    result = plan_bang_bang(start[axis], target[axis], axis < 2 ? split.limits(fastest, axis) : yaw, trajectories[axis], how);
  }
  return result;
}

#define ROBOT_CORE_INSTANTIATE(Real)                                                                                           \
  template PlanResult plan_plane(const AxisState<Real>(&)[3], const AxisState<Real>(&)[3], const PlaneLimits<Real>&,           \
                                 const AxisLimits<Real>&, Trajectory<Real>(&)[3], Target);                                     \
  template PlanResult plan_plane_velocity(const AxisState<Real>(&)[3], const AxisState<Real>(&)[3], const PlaneLimits<Real>&,  \
                                          const AxisLimits<Real>&, Trajectory<Real>(&)[3]);                                    \
  template PlanResult plan_plane_bang_bang(const AxisState<Real>(&)[3], const AxisState<Real>(&)[3], const PlaneLimits<Real>&, \
                                           const AxisLimits<Real>&, Trajectory<Real>(&)[3], Target)

ROBOT_CORE_INSTANTIATE(float);
#ifndef ROBOT_CORE_WITHOUT_DOUBLE
ROBOT_CORE_INSTANTIATE(double);
#endif

}  // namespace robot_core
