// Expectations that every result of the planners must meet.
#pragma once

#include <string>
#include <vector>

#include "trajectory_reference.h"

namespace robot_core::reference {

/// Number of random problems per test; HEATSOAK_TRAJECTORY_PROBLEMS=1000000 is the long run.
int problem_count();

template <typename Real>
State widened(const AxisState<Real>& s) {
  return {static_cast<double>(s.position), static_cast<double>(s.velocity), static_cast<double>(s.acceleration)};
}

template <typename Real>
Limits widened(const AxisLimits<Real>& l) {
  return {static_cast<double>(l.velocity_max), static_cast<double>(l.velocity_min), static_cast<double>(l.acceleration_max),
          static_cast<double>(l.acceleration_min), static_cast<double>(l.jerk_max)};
}

/// Returns a task in the notation of a test's source.
std::string text(const Task& task);

/// Returns the result of plan_position, which must be ok.
Motion planned(const Task& task);
double duration_s(const Task& task);

/// `most` bounds the errors of end and limits, relative to the task's scales.
void expect_flawless(const Motion& motion, const Task& task, double judged_from_s = 0.0, double most = 1e-10);

struct Fleet {
  std::vector<Task> tasks;
  std::vector<Motion> motions;
};

/// Return the results of plan_synchronised or plan_velocity_synchronised, which must be ok.
Fleet synchronised(std::vector<Task> tasks);
Fleet velocity_synchronised(std::vector<Task> tasks);

}  // namespace robot_core::reference
