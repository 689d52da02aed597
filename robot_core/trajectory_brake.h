// Problem of one axis, and the brake that leads a start outside the limits back inside. Part of the trajectory planner.
#pragma once

#include "robot_core/math.h"
#include "robot_core/trajectory.h"
#include "robot_core/trajectory_limits.h"
#include "robot_core/trajectory_path.h"

namespace robot_core::detail {

/// Problem of one axis in units of its jerk_max, after its brake.
template <typename Real>
struct Problem {  // NOLINT(cppcoreguidelines-pro-type-member-init): pose() fills it
  Real v0, a0, v1, a1;
  Real velocity_max, velocity_min, acceleration_max, acceleration_min;  ///< the minima are magnitudes
  Real distance;
  Real distance_scale;  ///< magnitude of the positions whose difference is `distance`
  Real brake_s;
  Path<Real, 2> brake;
};

/// Brakes a start that moves upwards too fast, now or inevitably soon. Jerks down until the velocity sinks below `velocity_max`, and stops
/// earlier if `velocity_min` would otherwise be violated.
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

/// Brakes a start with too much acceleration: jerks down to the limit, then holds it as long as a velocity limit requires it.
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

/// Leads a start outside the limits back inside.
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

/// Returns true if no limit is violated yet, but a velocity limit will be unless the motion ends before.
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

/// Converts a task to units of jerk_max in the frame of a moving target. Returns the error of an invalid state, target or limit.
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

}  // namespace robot_core::detail
