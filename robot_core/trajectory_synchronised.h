// Several axes that arrive together. Part of the trajectory planner.
#pragma once

#include <limits>

#include "robot_core/trajectory.h"
#include "robot_core/trajectory_arrival.h"
#include "robot_core/trajectory_lead.h"

namespace robot_core::detail {

/// Arrivals closer than this count as one. Rounding of a start shifts an arrival by much more than its own size. An axis that misses
/// an arrival at a corner of the reachable set would have to come back. The target is missed by at most 1e-9 of the range of the
/// limits.
template <typename Real>
Real same_time_s(const Problem<Real>& p) {
  constexpr Real kTogether = std::numeric_limits<Real>::digits > 32 ? Real(1e-9) : Real(1e-4);
  return kTogether * smaller(p.acceleration_max + p.acceleration_min, square_root(p.velocity_max + p.velocity_min)) / Real(2);
}

/// Returns true if an axis keeps its limits from its start on.
template <typename Real>
bool starts_inside(const Axis<Real>& axis) {
  const Problem<Real>& p = axis.problem;
  // An axis that returns by its own acceleration has no brake.
  return !axis.may_be_early && p.brake.count == 0 && p.v0 <= p.velocity_max && -p.v0 <= p.velocity_min;
}

/// Appends `way` to the trajectory. Fails if it misses the target or, with a start inside the limits, breaks them.
template <typename Real>
PlanResult finish(bool is_inside, bool waits, const Way<Real>& way, const AxisState<Real>& start, const AxisState<Real>& target,
                  const AxisLimits<Real>& limits, Target how, Trajectory<Real>& trajectory) {
  if (!lay_out_behind(way, limits, trajectory)) {
    trajectory.segment_count = 0;
    return PlanResult::out_of_range;
  }
  AxisState<Real> met = target;
  if (how == Target::moving_on) {
    met.position += target.velocity * trajectory.duration_s;
    met.acceleration = Real(0);
  }
  if (!close_at(met, start, limits, waits, trajectory) || (is_inside && !keeps_limits(trajectory, limits))) {
    trajectory.segment_count = 0;
    return PlanResult::out_of_range;
  }
  return PlanResult::ok;
}

/// Plans axes that arrive together. The first `lead_count` axes are planned from the end of their lead.
template <typename Real>
class Together {
 public:
  Together(int axis_count, Target how, const Lead<Real>* leads, int lead_count)
      : axis_count_(axis_count), how_(how), leads_(leads), lead_count_(lead_count) {}

  /// Prepares every axis and finds the first time at which all can arrive.
  PlanResult agree(const AxisState<Real>* start, const AxisState<Real>* target, const AxisLimits<Real>* limits, int& failed_axis) {
    for (int i = 0; i < axis_count_; ++i) {
      AxisState<Real> met = target[i];
      if (how_ == Target::moving_on) {
        met.position += target[i].velocity * lead_s(i);
      }
      failed_axis = i;
      if (const PlanResult result = pose_axis(i < lead_count_ ? leads_[i].end : start[i], met, limits[i], how_, axes_[i]);
          result != PlanResult::ok) {
        return result;
      }
      arrive_first(axes_[i], arrivals_[i]);
      duration_s_ = larger(duration_s_, lead_s(i) + arrivals_[i].duration_s);
    }
    // An axis that cannot arrive at this time delays all. Each axis has only a few time intervals without an arrival.
    constexpr int kMostDelays = 8 * kMostAxes;
    for (int delay = 0; delay < kMostDelays && !agrees_with_all(); ++delay) {
    }
    return PlanResult::ok;
  }

  PlanResult lay_out(const AxisState<Real>* start, const AxisState<Real>* target, const AxisLimits<Real>* limits,
                     Trajectory<Real>* trajectories, int& failed_axis) {
    for (int i = 0; i < axis_count_; ++i) {
      begin_at(start[i], trajectories[i]);
      if (i < lead_count_) {
        lay_out_lead(leads_[i], trajectories[i]);
      }
      Way<Real> way;
      append_arrival(axes_[i], arrivals_[i], way);
      failed_axis = i;
      if (const PlanResult result =
              finish(i >= lead_count_ && starts_inside(axes_[i]), true, way, start[i], target[i], limits[i], how_, trajectories[i]);
          result != PlanResult::ok) {
        return result;
      }
      if (how_ == Target::moving_on) {
        trajectories[i].target.position = target[i].position + target[i].velocity * duration_s_;
      }
      trajectories[i].duration_s = duration_s_;
    }
    return PlanResult::ok;
  }

 private:
  [[nodiscard]] Real lead_s(int axis) const { return axis < lead_count_ ? leads_[axis].duration_s : Real(0); }

  /// Returns true if every axis arrives at duration_s_. Otherwise sets duration_s_ to the next arrival of an axis that cannot.
  bool agrees_with_all() {
    for (int i = 0; i < axis_count_; ++i) {
      AxisArrival<Real>& arrival = arrivals_[i];
      const Real same_s = same_time_s(axes_[i].problem);
      const Real asked_s = duration_s_ - lead_s(i);
      if (absolute(asked_s - arrival.duration_s) <= same_s) {
        continue;
      }
      arrive_from(axes_[i], asked_s, arrival);
      if (arrival.duration_s > asked_s + same_s) {
        // The end of a time interval with arrivals is a corner as well.
        const Real later_s = arrival.duration_s;
        arrive_from(axes_[i], asked_s - same_s, arrival);
        if (arrival.duration_s > asked_s) {
          duration_s_ = lead_s(i) + later_s;
          return false;
        }
      }
    }
    return true;
  }

  int axis_count_;
  Target how_;
  const Lead<Real>* leads_;
  int lead_count_;
  Real duration_s_ = 0;
  Axis<Real> axes_[kMostAxes];
  AxisArrival<Real> arrivals_[kMostAxes];
};

template <typename Real>
PlanResult plan_together(int axis_count, const AxisState<Real>* start, const AxisState<Real>* target, const AxisLimits<Real>* limits,
                         const Lead<Real>* leads, int lead_count, Trajectory<Real>* trajectories, Target how, int* failed_axis) {
  if (!is_axis_count(axis_count)) {
    return PlanResult::not_that_many_axes;
  }
  Together<Real> together(axis_count, how, leads, lead_count);
  int axis = 0;
  PlanResult result = together.agree(start, target, limits, axis);
  if (result == PlanResult::ok) {
    result = together.lay_out(start, target, limits, trajectories, axis);
  }
  if (result != PlanResult::ok && failed_axis != nullptr) {
    *failed_axis = axis;
  }
  return result;
}

}  // namespace robot_core::detail
