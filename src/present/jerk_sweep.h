// Document and JSON of `simulate --jerk-sweep`.
#pragma once

#include <string>

#include "present/document.h"
#include "present/json.h"
#include "simulate/planner_study.h"

namespace heatsoak::present {

/// Returns the jerk limit whose drives settle first, for the robot's own acceleration, which comes first.
std::string settling_words(const simulate::JerkSweep& sweep);

Document jerk_sweep_document(const simulate::JerkSweep& sweep);
Json jerk_sweep_json(const simulate::JerkSweep& sweep);

}  // namespace heatsoak::present
