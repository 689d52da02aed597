// Chart of `simulate --jerk-sweep`: effect of the jerk limit on slip, time, precision and heat.
#pragma once

#include "report/chart.h"
#include "simulate/planner_study.h"

namespace heatsoak::present {

report::Chart jerk_sweep_chart(const simulate::JerkSweep& sweep);

}  // namespace heatsoak::present
