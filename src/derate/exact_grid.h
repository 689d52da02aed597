// Exact heats of a barrier on a fine grid.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "derate/barrier.h"
#include "derate/current_table.h"

namespace heatsoak::derate {

enum Axis : std::size_t { speed, stator, winding, kAxes };
using Index = std::array<std::size_t, kAxes>;
using Places = std::array<std::vector<std::size_t>, kAxes>;  ///< per axis of a table: indices of grid points, ascending

/// Exact heats, as in CurrentTable, on a fine grid. Its points are the candidate breakpoints of a table.
struct ExactGrid {
  std::array<std::vector<double>, kAxes> points;
  std::vector<double> heat_A2;          ///< [speed][stator][winding]
  std::vector<double> square_per_heat_ratio;  ///< reciprocal of the resistance ratio at every point of the winding's axis
  std::size_t limit = 0;                ///< index of the winding's limit on the winding's axis

  [[nodiscard]] std::size_t place(const Index& at) const {
    return (at[speed] * points[stator].size() + at[stator]) * points[winding].size() + at[winding];
  }
  /// Squared current at a place of the grid.
  [[nodiscard]] double square_A2(std::size_t place) const { return heat_A2[place] * square_per_heat_ratio[place % points[winding].size()]; }
};

/// Computes the grid of the barrier. `table` gives the resistance ratio.
ExactGrid exact_grid(const CurrentTable& table, Barrier& barrier, const BarrierRules& rules);

}  // namespace heatsoak::derate
