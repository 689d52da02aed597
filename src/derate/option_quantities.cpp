#include "derate/option_quantities.h"

#include "base/air_range.h"

namespace heatsoak::derate {

std::vector<OptionQuantity> option_quantities(DerateOptions& options) {
  return {
      {{"ambient", "degC", base::kPossibleAir_C, "hottest air at the motor; 40degC unless given"}, &options.hottest_ambient_C},
      {{"coldest", "degC", base::kPossibleAir_C, "coldest air; a sensor that reads less is treated as faulty; 0degC unless given"},
       &options.coldest_ambient_C},
      {{"approach", "s", base::Range::between(0.01, 100.0),
        "time in which the winding approaches its limit under full use; a shorter time allows higher peaks of a cold winding, a longer one "
        "more current late in a long load; a quarter of the winding's time constant unless given, the whole at most"},
       &options.approach_s},
      {{"confidence", "", base::Range::between(0.5, 0.999),
        "least share of motors that keep their limits, shown with 95 % certainty; 0.95 unless given"},
       &options.guarantee.required_share},
      {{"error", "", base::Range::between(0.002, 0.5),
        "largest loss of current in the table against the exact result of its safety factor; a coarse table loses current between its "
        "points, which can lower the safety factor; 1 % unless given"},
       &options.table.shortfall_ratio}};
}

}  // namespace heatsoak::derate
