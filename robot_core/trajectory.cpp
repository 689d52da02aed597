#include "robot_core/trajectory.h"

#include <limits>

#include "robot_core/trajectory_arrival.h"

namespace robot_core {
namespace detail {
namespace {

/// Arrivals that are this close are one. Rounding of a start moves the time of an arrival by much more than its own size, and a corner of
/// what can be reached has no second chance: an axis that flies by its target would have to come back. The target is missed by a part of
/// 1e-9 of what the limits reach.
template <typename Real>
Real same_time_s(const Problem<Real>& p) {
  constexpr Real kTogether = std::numeric_limits<Real>::digits > 32 ? Real(1e-9) : Real(1e-4);
  return kTogether * smaller(p.acceleration_max + p.acceleration_min, square_root(p.velocity_max + p.velocity_min)) / Real(2);
}

template <typename Real>
PlanResult finish(const Way<Real>& way, const AxisState<Real>& start, const AxisState<Real>& target, const AxisLimits<Real>& limits,
                  Target how, Trajectory<Real>& trajectory) {
  if (!lay_out(way, start, limits, trajectory)) {
    trajectory.segment_count = 0;
    return PlanResult::out_of_range;
  }
  AxisState<Real> met = target;
  if (how == Target::moving_on) {
    met.position += target.velocity * trajectory.duration_s;
    met.acceleration = Real(0);
  }
  return close_at(met, start, limits, trajectory) ? PlanResult::ok : PlanResult::out_of_range;
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
      const Real same_s = same_time_s(axes[agreed].problem);
      if (absolute(duration_s - arrival.duration_s) <= same_s) {
        continue;
      }
      arrive_from(axes[agreed], duration_s, arrival);
      if (arrival.duration_s > duration_s + same_s) {
        // The end of a span of time with arrival is a corner as well.
        const Real later_s = arrival.duration_s;
        arrive_from(axes[agreed], duration_s - same_s, arrival);
        if (arrival.duration_s > duration_s) {
          duration_s = later_s;
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

#define ROBOT_CORE_INSTANTIATE(Real)                                                                                                     \
  template PlanResult plan_position(const AxisState<Real>&, const AxisState<Real>&, const AxisLimits<Real>&, Trajectory<Real>&, Target); \
  template PlanResult plan_synchronised(int, const AxisState<Real>*, const AxisState<Real>*, const AxisLimits<Real>*, Trajectory<Real>*, \
                                        Target, int*)

ROBOT_CORE_INSTANTIATE(float);
#ifndef ROBOT_CORE_WITHOUT_DOUBLE
ROBOT_CORE_INSTANTIATE(double);
#endif

}  // namespace robot_core
