// Document of `simulate --jerk-sweep`.
#pragma once

#include <span>

#include "present/document.h"
#include "simulate/planner_study.h"

namespace heatsoak::present {

Document jerk_sweep_document(std::span<const StudyResult> results, const Robot& robot, const Motor& motor);

}  // namespace heatsoak::present
