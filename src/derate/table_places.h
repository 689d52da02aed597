// Chooses the breakpoints of a derating table and computes the copper heat of the allowed current there.
#pragma once

#include <functional>
#include <memory>

#include "derate/barrier.h"
#include "derate/current_table.h"

namespace heatsoak::derate {

struct ExactGrid;

/// Exact heats on a fine grid, whose points are the candidate breakpoints of a table.
class HeatPlaces {
 public:
  /// `table` gives the resistance ratio.
  HeatPlaces(const CurrentTable& table, Barrier& barrier, const BarrierRules& rules);
  ~HeatPlaces();
  HeatPlaces(const HeatPlaces&) = delete;
  HeatPlaces& operator=(const HeatPlaces&) = delete;

  /// Sets axes, heats, straight_below_A and the shortfall relative to the grid. Adds breakpoints one by one, each on the axis where it
  /// reduces the largest shortfall most per stored number, and removes unnecessary ones. The table never exceeds the grid's exact heats.
  void place(CurrentTable& table, const TableGoal& goal) const;

  /// Removes each inner breakpoint of a table from place() without which `is_good` accepts the table, and an axis of two breakpoints
  /// alike. `is_good` receives the heats of place() and may lower them.
  void remove(CurrentTable& table, const std::function<bool(CurrentTable&)>& is_good) const;

 private:
  BarrierRules rules_;
  std::unique_ptr<const ExactGrid> grid_;
};

}  // namespace heatsoak::derate
