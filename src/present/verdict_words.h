// Phrases that several commands share.
#pragma once

#include <string>

#include "robot/robot.h"
#include "select/evaluate.h"

namespace heatsoak::present {

/// Formats a duration: "58 s", "12 min".
std::string duration_text(double duration_s);

/// Returns a line that the ground contacts cannot transmit the demanded motion; empty if they nearly always can.
std::string slip_text(const duty::WheelDemand& wheel);

/// Returns a line that explains why a motor cannot deliver the demand; empty if it can.
std::string why_infeasible(const select::MotorEvaluation& motor, const robot::Robot& robot);

}  // namespace heatsoak::present
