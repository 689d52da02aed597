#include <fmt/format.h>

#include "derate/c_header/c_text.h"
#include "derate/c_header/parts.h"
#include "derate/plausible_range.h"

namespace heatsoak::derate::c_header {

std::string constants(const Source& source) {
  const Derating& derating = source.derating;
  const auto define = [&](std::string_view name, double value) {
    return fmt::format("#define {}_{} {}\n", source.capital, name, literal(value));
  };
  return define("PERIOD_S", derating.options.period_s) + define("WINDING_LIMIT_C", derating.rules.limits.winding_C) +
         define("HOTTEST_AMBIENT_C", derating.rules.hottest_ambient_C) + define("COLDEST_AMBIENT_C", derating.options.coldest_ambient_C) +
         define("MOST_STATE_C", kMostState_C) + define("MOST_CURRENT_A", derating.table.most_current_A) +
         define("MOST_SPEED_RAD_PER_S", derating.table.most_speed_rad_per_s) +
         define("NO_CURRENT_SPEED_RAD_PER_S", derating.table.no_current_speed_rad_per_s) +
         define("RESISTANCE_AT_0C_RATIO", derating.table.resistance_at_0C_ratio) +
         define("RESISTANCE_RATIO_PER_K", derating.table.resistance_ratio_per_K) +
         define("STRAIGHT_BELOW_A", derating.table.straight_below_A) + define("WINDING_PER_STATOR_K", derating.table.winding_per_stator_K) +
         define("REACHABLE_SPEED_RAD_PER_S", derating.reachable_speed_rad_per_s) +
         define("TORQUE_CONSTANT_NM_PER_A", derating.torque_constant_Nm_per_A) +
         "/* Continuous current at every speed and in every hot case, for a wheel of unknown speed: the lowest current that the table "
         "allows in the\n   steady state of each continuous use at the full allowed current; 0 if no such use was simulated. */\n" +
         define("LIMP_CURRENT_A", limp_current_A(derating)) + fmt::format("#define {}_STARTED 0x48454154u\n\n", source.capital);
}

}  // namespace heatsoak::derate::c_header
