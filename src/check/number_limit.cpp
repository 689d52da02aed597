#include "check/number_limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/copper.h"
#include "check/answer_number.h"
#include "check/limit.h"
#include "check/thresholds/peak.h"

namespace heatsoak::check {
namespace {

/// A percentage is a pure number that is shown in percent.
void set_type(Limit& limit, std::string name, std::string unit, Bound direction, bool is_share) {
  const auto own = std::make_shared<NumberType>();
  own->name = std::move(name);
  own->unit = std::move(unit);
  own->example = fmt::format("{} 1{}{}", to_string(direction), own->unit.empty() ? "" : " ", own->unit);
  own->type.name = own->name;
  own->type.unit = own->unit;
  own->type.is_share = is_share;
  own->type.direction = direction;
  own->type.example = own->example;
  if (own->unit == "degC") {
    own->type.range = thresholds::kPlausible_C;  // 70 K of a rise would be -203 degC
  }
  limit.type = &own->type;
  limit.own = own;
}

double worse_end(const AnswerNumber& number, Bound direction) {
  return !number.interval ? number.value : direction == Bound::at_most ? number.interval->high : number.interval->low;
}

}  // namespace

std::string parse_number_limit(std::string_view name, std::string_view text, Limit& limit) {
  const bool is_at_least = text.substr(std::min(text.find_first_not_of(" \t"), text.size())).starts_with(to_string(Bound::at_least));
  const std::string unit = unit_of_limit(text);
  const bool is_share = unit == "%";
  set_type(limit, std::string(name), is_share ? "" : unit, is_at_least ? Bound::at_least : Bound::at_most, is_share);
  const ParsedLimit parsed = parse_limit(text, *limit.type);
  limit.value = parsed.value;
  limit.unit = parsed.unit;
  limit.text = text;
  return parsed.problem;
}

Measured measure_number(Limit& limit, const nlohmann::ordered_json& answer) {
  const Bound direction = limit.type->direction;
  const std::vector<AnswerNumber> numbers = numbers_at(answer, limit.type->name);
  const auto is_worse = [direction](const AnswerNumber& one, const AnswerNumber& other) {
    return direction == Bound::at_most ? worse_end(one, direction) > worse_end(other, direction)
                                       : worse_end(one, direction) < worse_end(other, direction);
  };
  const AnswerNumber& worst = *std::ranges::min_element(numbers, is_worse);
  for (const AnswerNumber& each : numbers) {
    if (each.unit != worst.unit) {
      throw base::Failure(base::ExitCode::cannot_answer, fmt::format("'{}' and '{}' have different units; expected a limit for each",
                                                                     worst.name, each.name));
    }
  }
  set_type(limit, std::string(limit.type->name), worst.unit, direction, limit.type->is_share);
  const ParsedLimit parsed = parse_limit(limit.text, *limit.type);
  if (!parsed.problem.empty()) {
    throw base::Failure(base::ExitCode::bad_input, parsed.problem);
  }
  limit.value = parsed.value;
  std::string detail = numbers.size() > 1 ? fmt::format("{}, of {} numbers", worst.name, numbers.size()) : std::string();
  if (worst.interval) {
    detail += fmt::format("{}{}, its 95 % interval {} to {}", detail.empty() ? "" : "; ", shown(worst.value, *limit.type),
                          shown(worst.interval->low, *limit.type), shown(worst.interval->high, *limit.type));
  }
  const double origin_value = worst.unit == "degC" ? base::kSheetTemperature_C : 0.0;
  return {worse_end(worst, direction), origin_value, detail};
}

}  // namespace heatsoak::check
