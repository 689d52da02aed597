// Chooses the breakpoints of a derating table and computes the copper heat of the allowed current there.
#pragma once

#include "derate/barrier.h"
#include "derate/current_table.h"

namespace heatsoak::derate {

/// Sets axes, heats, straight_below_A and the shortfall relative to a fine grid, for the table's resistance ratio. Adds breakpoints one by
/// one, each on the axis where it reduces the largest shortfall most per stored number, and removes unnecessary ones. The table never
/// exceeds the grid's exact heats.
void place_heats(CurrentTable& table, Barrier& barrier, const BarrierRules& rules, const TableGoal& goal);

}  // namespace heatsoak::derate
