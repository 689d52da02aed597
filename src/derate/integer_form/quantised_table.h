// The derating table with 16-bit squares, and how far it stays below the one in single precision.
#pragma once

#include <cstdint>
#include <vector>

#include "derate/current_table.h"
#include "derate/integer_form/integer_table.h"

namespace heatsoak::integer_form {

/// Owns what its table() points to.
struct QuantisedTable {
  explicit QuantisedTable(const CurrentTable& exact);

  std::vector<std::int32_t> speed_mrad_per_s;
  std::vector<std::int32_t> stator_mC;
  std::vector<std::int32_t> winding_mC;
  std::vector<std::int16_t> square;
  std::uint32_t unit_mA2 = 1;
  std::int32_t most_current_mA = 0;
  std::int32_t straight_below_mA = 1;
  std::int32_t most_speed_mrad_per_s = 0;
  std::int32_t no_current_speed_mrad_per_s = 1;
  std::int32_t winding_per_stator_K = 1;

  [[nodiscard]] heatsoak_integer_table table() const;
};

/// Largest share by which the quantised table is below `exact` where that allows straight_below or more, on a grid of temperatures half a
/// kelvin apart and ten speeds.
double quantised_shortfall_ratio(const CurrentTable& exact, const QuantisedTable& quantised);

}  // namespace heatsoak::integer_form
