#include "cli/default_spreads.h"

#include <fmt/format.h>

#include "cli/command.h"
#include "motor/default_spread.h"

namespace heatsoak {

std::string default_spreads_text(std::span<const Motor> motors) {
  std::string text;
  for (const Motor& motor : motors) {
    if (const std::vector<DefaultSpread> spreads = default_spreads(motor); !spreads.empty()) {
      text += fmt::format(
          "{}: the file gives no tolerance for these values, or one that is narrower than their origin supports; defaults by origin are "
          "assumed: {}; state the real ones\n",
          motor.id, to_string(spreads));
    }
  }
  return text;
}

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
