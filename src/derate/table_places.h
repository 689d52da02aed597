// Where the places of a derating table are, and the squares in them.
#pragma once

#include "derate/barrier.h"
#include "derate/current_table.h"

namespace heatsoak {

/// Sets axes, squares, straight_below and the shortfall on a fine grid. Places are added one by one where they lessen the largest shortfall
/// most for what they cost, and taken out again where they are not needed. No square of the grid lies below that of the table.
void place_squares(CurrentTable& table, Barrier& barrier, const BarrierRules& rules, const TableGoal& goal);

}  // namespace heatsoak
