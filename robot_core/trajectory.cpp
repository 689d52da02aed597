#include "robot_core/trajectory.h"

#include "robot_core/trajectory_arrival.h"
#include "robot_core/trajectory_synchronised.h"

namespace robot_core {
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
  begin_at(start, trajectory);
  return finish(starts_inside(axis), false, way, start, target, limits, how, trajectory);
}

template <typename Real>
PlanResult plan_synchronised(int axis_count, const AxisState<Real>* start, const AxisState<Real>* target, const AxisLimits<Real>* limits,
                             Trajectory<Real>* trajectories, Target how, int* failed_axis) {
  return plan_together<Real>(axis_count, start, target, limits, nullptr, 0, trajectories, how, failed_axis);
}

#define ROBOT_CORE_INSTANTIATE(Real)                                                                                                     \
  template PlanResult plan_position(const AxisState<Real>&, const AxisState<Real>&, const AxisLimits<Real>&, Trajectory<Real>&, Target); \
  template PlanResult plan_synchronised(int, const AxisState<Real>*, const AxisState<Real>*, const AxisLimits<Real>*, Trajectory<Real>*, \
                                        Target, int*);                                                                                   \
  template PlanResult detail::plan_together(int, const AxisState<Real>*, const AxisState<Real>*, const AxisLimits<Real>*,                \
                                            const Lead<Real>*, int, Trajectory<Real>*, Target, int*)

ROBOT_CORE_INSTANTIATE(float);
#ifndef ROBOT_CORE_WITHOUT_DOUBLE
ROBOT_CORE_INSTANTIATE(double);
#endif

}  // namespace robot_core
