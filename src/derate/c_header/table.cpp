#include <fmt/format.h>

#include <cmath>

#include "base/quantity.h"
#include "derate/c_header/c_text.h"
#include "derate/c_header/parts.h"
#include "derate/export_text.h"

namespace heatsoak::derate::c_header {
namespace {

constexpr std::string_view kTable = R"(static const heatsoak_current_table @_table = {
    {@_speed_rad_per_s, @SPEEDS@},
    {@_stator_C, @STATORS@},
    {@_winding_C, @WINDINGS@},
    @_heat_per_ohm_A2,
    @CAP@_RESISTANCE_AT_0C_RATIO,
    @CAP@_RESISTANCE_RATIO_PER_K,
    @CAP@_MOST_CURRENT_A,
    @CAP@_STRAIGHT_BELOW_A,
    @CAP@_MOST_SPEED_RAD_PER_S,
    @CAP@_NO_CURRENT_SPEED_RAD_PER_S,
    @CAP@_WINDING_PER_STATOR_K};

)";

constexpr std::string_view kAllowed = R"(/* speed_rad_per_s: magnitude; stator_C: the hottest node other than the winding */
static inline float @_allowed_A(float speed_rad_per_s, float stator_C, float winding_C) {
  const heatsoak_row row = heatsoak_find_row(&@_table, speed_rad_per_s, stator_C);
  return heatsoak_allowed_A(&@_table, &row, winding_C);
}

)";

}  // namespace

std::string table_comment(const CurrentTable& table) {
  const TableBound& bound = table.bound;
  const std::string at_one_place = " An axis with one grid point has no influence.";
  return fmt::format(
      "/* Copper heat of the allowed current. The table is never above the exact result of the network. Between grid points it is at "
      "most {} %\n"
      "   below it, for currents of {} A and more and windings below their limit. The allowed current changes by at most {} A per "
      "K of\n"
      "   the winding, {} A per K of the stator and {} A per rad/s.{} */\n",
      significant_above(100.0 * bound.shortfall_ratio, 2), base::significant(table.straight_below_A, 3),
      significant_above(bound.winding_slope_A_per_K, 3), significant_above(bound.stator_slope_A_per_K, 3),
      significant_above(bound.speed_slope_A_s_per_rad, 3),
      table.speed_rad_per_s.size() == 1 || table.stator_C.size() == 1 ? at_one_place : "");
}

std::string tables(const Source& source) {
  const CurrentTable& table = source.derating.table;
  return table_comment(table) + array(source.prefix + "_speed_rad_per_s", table.speed_rad_per_s) +
         array(source.prefix + "_stator_C", table.stator_C) + array(source.prefix + "_winding_C", table.winding_C) +
         "/* in A^2, I^2 * R / R25: by speed, then stator, then winding */\n" +
         array(source.prefix + "_heat_per_ohm_A2", table.heat_per_ohm_A2) +
         replaced(kTable, {{"@SPEEDS@", std::to_string(table.speed_rad_per_s.size())},
                           {"@STATORS@", std::to_string(table.stator_C.size())},
                           {"@WINDINGS@", std::to_string(table.winding_C.size())},
                           {"@CAP@", source.capital},
                           {"@", source.prefix}});
}

std::string allowed_function(const Source& source) { return replaced(kAllowed, {{"@", source.prefix}}); }

}  // namespace heatsoak::derate::c_header
