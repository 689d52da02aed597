// Chart of `simulate` for a match: one planner in detail, or two planners side by side.
#pragma once

#include "report/chart.h"
#include "simulate/match_simulation.h"

namespace heatsoak::present {

/// Returns the chart. The runs must contain their rows.
report::Chart match_chart(const simulate::MatchSimulation& match);

}  // namespace heatsoak::present
