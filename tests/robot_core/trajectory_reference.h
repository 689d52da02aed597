// What a trajectory planner is judged by, without any of its formulas: seeded problems, a walk along the result, a
// search through all switching structures by plain bisection, and a bound that proves a duration too short.
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

/// Full states inside of asymmetric limits, moderate scales.
Task random_task(std::mt19937_64& random);
/// Every quantity over several decades, many of them at a limit or zero, units of time and length over twelve decades.
Task extreme_task(std::mt19937_64& random);
/// Starts that break limits of velocity, acceleration or both.
Task violating_task(std::mt19937_64& random);

Task mirrored(const Task& task);
/// Read backwards. Only for starts inside of all limits, now and ever.
Task reversed(const Task& task);
Task scaled(const Task& task, double length, double time);

/// How far a trajectory is from being what it should be; all relative to the task's scales (see `scale_of`).
struct Flaws {
  double end = 0;    ///< state at the end, integrated segment by segment
  double gap = 0;    ///< jump between segments
  double limit = 0;  ///< beyond velocity and acceleration limits, after `judged_from_s`
  double jerk = 0;   ///< beyond the jerk limit
  double order = 0;  ///< segments that do not follow each other in time
};
Flaws flaws_of(const Motion& motion, const Task& task, double judged_from_s = 0);

/// The largest position, velocity and acceleration that play a part in a motion of that duration.
State scale_of(const Task& task, double duration_s);

/// The earliest arrival among all motions of at most two changes of the jerk's sign, with and without holding limits,
/// and those with a cruise at a velocity limit, found by sampling and bisection. Starts inside of the limits only.
double earliest_by_search(const Task& task, int samples);

/// True if no motion of that duration can exist: bounds on the velocity from both ends, drawn on a grid, and their
/// convex hull leave none. Never true for a duration that is possible.
bool is_impossible(const Task& task, double duration_s, int grid);

}  // namespace robot_core::reference
