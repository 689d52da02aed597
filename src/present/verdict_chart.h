// Chart of a verdict: winding (top) and stator (bottom) temperature over time, with the limits.
#pragma once

#include <vector>

#include "duty/duty.h"
#include "report/chart.h"
#include "robot/robot.h"
#include "select/evaluate.h"

namespace heatsoak::present {

/// Maximum number of motors: the one that the robot is built with, then the best of the others.
inline constexpr std::size_t kMostCurves = 6;
report::Chart verdict_chart(const std::vector<select::MotorEvaluation>& results, const robot::Robot& robot, const duty::Duty& duty);

}  // namespace heatsoak::present
