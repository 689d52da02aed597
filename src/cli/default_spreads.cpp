#include "cli/default_spreads.h"

#include "cli/command.h"
#include "motor/default_spread.h"

namespace heatsoak {

nlohmann::ordered_json default_spreads_json(std::span<const Motor> motors) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const Motor& motor : motors) {
    for (const DefaultSpread& each : default_spreads(motor)) {
      rows.push_back({{"motor", motor.id},
                      {"key", each.key},
                      {"origin", to_string(each.origin)},
                      {"low_ratio", rounded(each.spread.low / each.value, 4)},
                      {"high_ratio", rounded(each.spread.high / each.value, 4)}});
    }
  }
  return rows;
}

}  // namespace heatsoak
