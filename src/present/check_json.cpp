#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "present/check.h"
#include "present/check_words.h"

namespace heatsoak::present {
namespace {

Json json(const check::Outcome& each) {
  const check::ThresholdType& type = *each.limit.type;
  return {{"name", fmt::format("{}: {}", each.check->name, type.name)},
          {"check", each.check->name},
          {"threshold", type.name},
          {"value", each.measured ? rounded(each.measured->value, 6) : Json()},
          {"direction", type.direction == check::Bound::at_most ? "at_most" : "at_least"},
          {"limit", rounded(each.limit.value, 6)},
          {"margin", rounded(each.margin_value(), 6)},
          {"unit", type.unit},
          {"passed", each.passed()},
          {"evaluated", each.measured.has_value()},
          {"reason", reason_words(each)},
          {"detail", basis_words(each)},
          {"limit_before", each.before.empty() ? Json() : Json(each.before)},
          {"file", each.limit.at.file},
          {"line", each.limit.at.line.value_or(0)},
          {"column", each.limit.at.column.value_or(0)}};
}

}  // namespace

Json check_json(std::span<const check::Outcome> outcomes, const std::vector<std::string>& files) {
  Json thresholds = Json::array();
  std::ranges::transform(outcomes, std::back_inserter(thresholds), [](const check::Outcome& each) { return json(each); });
  return {{"schema", "heatsoak.check/1"},
          {"files", files},
          {"passed", std::ranges::all_of(outcomes, &check::Outcome::passed)},
          {"thresholds", thresholds}};
}

}  // namespace heatsoak::present
