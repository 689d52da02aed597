// What several verbs say in the same words.
#pragma once

#include <string>

#include "robot/robot.h"
#include "select/evaluate.h"

namespace heatsoak {

/// "58 s", "12 min".
std::string duration_text(double duration_s);

/// That the ground cannot carry the motion that a demand comes from, as one line with its end; empty where it nearly always can.
std::string slip_text(const WheelDemand& wheel);

/// Why a motor cannot deliver what is demanded, as one line with its end; empty where it can.
std::string why_infeasible(const MotorEvaluation& motor, const Robot& robot);

}  // namespace heatsoak
