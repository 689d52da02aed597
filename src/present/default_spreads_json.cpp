#include "present/default_spreads_json.h"

#include <nlohmann/json.hpp>

#include "motor/default_spread.h"

namespace heatsoak::present {

Json default_spreads_json(std::span<const motor::Motor> motors) {
  Json rows = Json::array();
  for (const motor::Motor& motor : motors) {
    for (const motor::DefaultSpread& each : motor::default_spreads(motor)) {
      rows.push_back({{"motor", motor.id},
                      {"key", each.key},
                      {"origin", base::to_string(each.origin)},
                      {"low_ratio", rounded(each.spread.low / each.value, 4)},
                      {"high_ratio", rounded(each.spread.high / each.value, 4)}});
    }
  }
  return rows;
}

}  // namespace heatsoak::present
