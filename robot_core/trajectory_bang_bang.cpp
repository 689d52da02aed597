#include "robot_core/trajectory.h"
#include "robot_core/trajectory_limits.h"
#include "robot_core/trajectory_path.h"

namespace robot_core {
namespace detail {
namespace {

/// Appends segments of constant acceleration.
template <typename Real>
class Steps {
 public:
  Steps(const AxisState<Real>& start, Trajectory<Real>& trajectory)
      : trajectory_(trajectory), state_{start.position, start.velocity, Real(0)} {
    trajectory_.segment_count = 0;
  }

  void add(Real for_s, Real acceleration) {
    if (for_s > Real(0)) {
      state_.acceleration = acceleration;
      trajectory_.segments[trajectory_.segment_count] = {time_s_, for_s, Real(0), state_};
      ++trajectory_.segment_count;
      time_s_ += for_s;
      state_ = Trajectory<Real>::advanced(state_, Real(0), for_s);
    }
  }

  [[nodiscard]] const AxisState<Real>& state() const { return state_; }
  [[nodiscard]] Real time_s() const { return time_s_; }

 private:
  Trajectory<Real>& trajectory_;
  AxisState<Real> state_;
  Real time_s_ = 0;
};

/// Appends a motion from v0 to v1 over `distance` with velocities from `lower` to `upper`: raise, cruise, fall, or its mirror image.
template <typename Real>
void cover(Real distance, Real v0, Real v1, Real lower, Real upper, const AxisLimits<Real>& limits, Steps<Real>& steps) {
  // Compare with the direct change of velocity to find the direction.
  const Real direct = (v1 * v1 - v0 * v0) / (Real(2) * (v1 > v0 ? limits.acceleration_max : limits.acceleration_min));
  const Real sign = distance < direct ? Real(-1) : Real(1);
  const Real raise = sign > Real(0) ? limits.acceleration_max : -limits.acceleration_min;
  const Real fall = sign > Real(0) ? -limits.acceleration_min : limits.acceleration_max;
  const Real limit = sign > Real(0) ? upper : -lower;
  const Real per_square = Real(1) / (Real(2) * raise) + Real(1) / (Real(2) * fall);
  const Real square = (sign * distance + v0 * v0 / (Real(2) * raise) + v1 * v1 / (Real(2) * fall)) / per_square;
  const Real least = larger(sign * v0, sign * v1);
  const Real top = larger(square_root(square), least);
  const Real reached = smaller(top, larger(limit, least));
  steps.add((reached - sign * v0) / raise, sign * raise);
  if (top > reached) {
    steps.add((square - reached * reached) * per_square / reached, Real(0));
  }
  steps.add((reached - sign * v1) / fall, -sign * fall);
}

}  // namespace
}  // namespace detail

using namespace detail;

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
  const Real v0 = start.velocity - frame;
  const Real within = clamped(v0, lower, upper);
  const Real back = v0 > within ? limits.acceleration_min : limits.acceleration_max;
  Steps<Real> steps(start, trajectory);
  steps.add((within - v0) / back, back);
  cover(target.position - steps.state().position + frame * steps.time_s(), within, target.velocity - frame, lower, upper, limits, steps);
  trajectory.duration_s = steps.time_s();
  trajectory.target = {steps.state().position, steps.state().velocity, Real(0)};
  const AxisState<Real> met{target.position + frame * steps.time_s(), target.velocity, Real(0)};
  return is_finite(steps.time_s()) && close_at(met, start, limits, false, trajectory) ? PlanResult::ok : PlanResult::out_of_range;
}

#define ROBOT_CORE_INSTANTIATE(Real) \
  template PlanResult plan_bang_bang(const AxisState<Real>&, const AxisState<Real>&, const AxisLimits<Real>&, Trajectory<Real>&, Target)

ROBOT_CORE_INSTANTIATE(float);
#ifndef ROBOT_CORE_WITHOUT_DOUBLE
ROBOT_CORE_INSTANTIATE(double);
#endif

}  // namespace robot_core
