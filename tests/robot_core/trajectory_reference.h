// Reference for a trajectory planner without any of its formulas. It has seeded problems, a walk along the result, and a search through all
// switching structures by plain bisection. A bound proves durations that are too short.
#pragma once

#include <optional>
#include <random>
#include <vector>

#include "robot_core/trajectory.h"

namespace robot_core::reference {

using State = AxisState<double>;
using Limits = AxisLimits<double>;
using Motion = Trajectory<double>;

inline double uniform(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

struct Task {
  State start;
  State target;
  Limits limits;
};

/// Full states inside asymmetric limits, with moderate scales.
Task random_task(std::mt19937_64& random);
/// Every quantity varies over several decades, many are at a limit or zero; units of time and length vary over twelve decades.
Task extreme_task(std::mt19937_64& random);
/// Starts that violate limits of velocity, acceleration or both.
Task violating_task(std::mt19937_64& random);

Task mirrored(const Task& task);
/// Returns the task read backwards. Only for starts that are inside all limits and stay inside.
Task reversed(const Task& task);
Task scaled(const Task& task, double length, double time);

/// Errors of a trajectory, all relative to the task's scales (see `scale_of`).
struct Flaws {
  double end = 0;    ///< error of the state at the end, integrated segment by segment
  double gap = 0;    ///< jump between segments
  double limit = 0;  ///< excess over velocity and acceleration limits, after `judged_from_s`
  double jerk = 0;   ///< excess over the jerk limit
  double order = 0;  ///< segments that do not follow each other in time
};
Flaws flaws_of(const Motion& motion, const Task& task, double judged_from_s = 0);

/// Returns the largest position, velocity and acceleration that occur in a motion of that duration.
State scale_of(const Task& task, double duration_s);

/// Returns the earliest arrival among the motions with at most two changes of the jerk's sign. Includes motions that hold a limit or cruise
/// at a velocity limit. Uses sampling and bisection. Only for starts inside the limits.
double earliest_by_search(const Task& task, int samples);

/// Returns true if no motion of that duration can exist: velocity bounds from both ends, drawn on a grid, and their convex hull leave none.
/// Never true for a possible duration.
bool is_impossible(const Task& task, double duration_s, int grid);

}  // namespace robot_core::reference
