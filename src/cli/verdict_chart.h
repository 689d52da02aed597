// The picture of a verdict: winding above, stator below, over time, with the limit.
#pragma once

#include <vector>

#include "duty/duty.h"
#include "report/chart.h"
#include "robot/robot.h"
#include "select/evaluate.h"

namespace heatsoak {

/// Shows at most kMostCurves motors: the one the robot is built with first, then the best of the others.
inline constexpr std::size_t kMostCurves = 6;
Chart verdict_chart(const std::vector<MotorEvaluation>& results, const Robot& robot, const Duty& duty);

}  // namespace heatsoak
