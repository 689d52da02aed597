// One plan in the plane as bytes, with the same layout on host and target.
#pragma once

#include <cstdint>

#include "robot_core/trajectory.h"

namespace heatsoak::target {

struct PlannerRecord {
  robot_core::AxisState<float> start[3];
  robot_core::AxisState<float> target[3];
  robot_core::PlaneLimits<float> plane;
  robot_core::AxisLimits<float> yaw;
  std::int32_t how = 0;  ///< robot_core::Target
};

struct PlannerResult {
  std::int32_t result = 0;                   ///< robot_core::PlanResult
  robot_core::Trajectory<float> motions[3];  ///< unused segments are zero
};

/// Runs the planner. `result` must be zero before.
inline void run_planner(const PlannerRecord& record, PlannerResult& result) {
  using namespace robot_core;
  const PlanResult planned =
      plan_plane(record.start, record.target, record.plane, record.yaw, result.motions, static_cast<Target>(record.how));
  result.result = static_cast<std::int32_t>(planned);
}

/// Clears the segments that hold no values but may contain earlier data of the planner.
inline void clear_unused(PlannerResult& result) {
  for (robot_core::Trajectory<float>& motion : result.motions) {
    const bool is_planned = result.result == static_cast<std::int32_t>(robot_core::PlanResult::ok);
    motion.segment_count = is_planned ? motion.segment_count : 0;
    for (int i = motion.segment_count; i < robot_core::Trajectory<float>::kMostSegments; ++i) {
      motion.segments[i] = {};
    }
    if (!is_planned) {
      motion.duration_s = 0;
      motion.target = {};
    }
  }
}

}  // namespace heatsoak::target
