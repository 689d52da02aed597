// Document and JSON of `simulate --jerk-sweep`.
#pragma once

#include "present/document.h"
#include "present/json.h"
#include "simulate/planner_study.h"

namespace heatsoak::present {

Document jerk_sweep_document(const simulate::JerkSweep& sweep);
Json jerk_sweep_json(const simulate::JerkSweep& sweep);

}  // namespace heatsoak::present
