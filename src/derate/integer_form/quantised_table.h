// Derating table with 16-bit heats, and its shortfall relative to the table in single precision.
#pragma once

#include <cstdint>
#include <vector>

#include "derate/current_table.h"
#include "derate/integer_form/integer_table.h"

namespace heatsoak::derate::integer_form {

/// Quantised copy of a table, in thousandths of the units (mA, mrad/s, 0.001 °C). Owns the arrays that table() points to.
struct QuantisedTable {
  QuantisedTable() = default;
  explicit QuantisedTable(const CurrentTable& exact);

  std::vector<std::int32_t> speed_mrad_per_s;
  std::vector<std::int32_t> stator_mC;
  std::vector<std::int32_t> winding_mC;
  std::vector<std::int16_t> heat;  ///< in units of unit_mA2, in the order of CurrentTable::heat_per_ohm_A2
  std::uint32_t unit_mA2 = 1;
  std::int32_t resistance_at_first = 1;  ///< resistance ratio at the first winding point, in 2^-20, rounded up
  std::int32_t resistance_per_mK = 0;    ///< rise of the resistance ratio, in 2^-40 per 0.001 K, rounded up
  std::int32_t most_current_mA = 0;
  std::int32_t straight_below_mA = 1;
  std::int32_t most_speed_mrad_per_s = 0;
  std::int32_t no_current_speed_mrad_per_s = 1;
  std::int32_t winding_per_stator_K = 1;  ///< ratio in K per K, equal to CurrentTable::winding_per_stator_K

  [[nodiscard]] heatsoak_integer_table table() const;
  /// Returns the same table in A, rad/s and °C, without its bound. Its currents are those of the integers before they are rounded down to
  /// mA.
  [[nodiscard]] CurrentTable in_units() const;
};

/// Returns the largest relative shortfall of the quantised table against `exact` where that allows at least its straight_below_A, on a
/// grid of ten speeds and of temperatures 0.5 K apart.
double quantised_shortfall_ratio(const CurrentTable& exact, const QuantisedTable& quantised);

}  // namespace heatsoak::derate::integer_form
