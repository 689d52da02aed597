// What several verbs say in the same words.
#pragma once

#include <string>

#include "robot/robot.h"
#include "select/evaluate.h"

namespace heatsoak {

/// "58 s", "12 min".
std::string duration_text(double duration_s);

/// Why a motor cannot deliver what is demanded, as one line with its end; empty where it can.
std::string why_infeasible(const MotorEvaluation& motor, const Robot& robot);

}  // namespace heatsoak
