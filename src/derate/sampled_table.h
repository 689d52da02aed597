// Samples of a derating table for a reader that interpolates the current, instead of the copper heat, linearly.
#pragma once

#include <vector>

#include "derate/current_table.h"

namespace heatsoak::derate {

/// Smaller currents, as a ratio to the table's `straight_below_A`, do not count in the stated bound: there the table ends in an edge.
inline constexpr double kCounted_ratio = 2.0;

/// Currents on a full grid that contains the table's breakpoints up to the winding's limit; above it the reader allows no current. The
/// current interpolated linearly along all axes is at most 0.1 mA above the table's. Where the table reaches 0 inside of a cell, or falls
/// more steeply at its cold end, the samples are therefore below the table.
struct SampledTable {
  std::vector<double> speed_rad_per_s;  ///< ends where the table's current is 0
  std::vector<double> stator_C;
  std::vector<double> winding_C;  ///< ends at the limit
  std::vector<double> current_A;  ///< ≥ 0, rounded down to 10 µA; [speed][stator][winding]
  /// Largest share by which the interpolated current lies below the table's where that is at least
  /// kCounted_ratio · `straight_below_A`.
  /// From 0 to 1.
  double shortfall_ratio = 0.0;
};

/// `limit_C`: the winding's limit.
SampledTable sampled_table(const CurrentTable& table, double limit_C);

}  // namespace heatsoak::derate
