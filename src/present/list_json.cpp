#include <nlohmann/json.hpp>

#include "present/list.h"

namespace heatsoak::present {

Json list_json(std::string_view kind, std::span<const NamedThing> things) {
  Json items = Json::array();
  for (const NamedThing& each : things) {
    items.push_back({{"id", each.id}, {"summary", each.summary}});
  }
  return {{"schema", "heatsoak.list/1"}, {"kind", kind}, {"items", items}};
}

}  // namespace heatsoak::present
