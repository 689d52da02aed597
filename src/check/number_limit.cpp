#include "check/number_limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "base/copper.h"
#include "check/answer_number.h"
#include "check/limit.h"
#include "check/thresholds/peak.h"

namespace heatsoak::check {
namespace {

/// A percentage is a pure number that is shown in percent.
void set_type(Limit& limit, std::string name, std::string unit, Bound direction, bool is_share, bool is_whole = false) {
  const auto own = std::make_shared<NumberType>();
  own->name = std::move(name);
  own->unit = std::move(unit);
  own->example = fmt::format("{} 1{}{}", to_string(direction), own->unit.empty() ? "" : " ", own->unit);
  own->type.name = own->name;
  own->type.unit = own->unit;
  own->type.is_share = is_share;
  own->type.is_whole = is_whole;
  own->type.direction = direction;
  own->type.example = own->example;
  if (own->unit == "degC") {
    own->type.range = thresholds::kPlausible_C;  // 70 K of a rise would be -203 degC
  }
  limit.type = &own->type;
  limit.own = own;
}

/// Returns the end of the interval that is nearer to violating the limit; infinite if the answer has no such end.
double worse_end(const AnswerNumber& number, Bound direction) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  return !number.interval              ? number.value
         : direction == Bound::at_most ? number.interval->high.value_or(kNone)
                                       : number.interval->low.value_or(-kNone);
}

/// Returns the interval of a number as text, or what is compared instead.
std::string interval_text(const AnswerNumber& number, const ThresholdType& type) {
  if (number.interval) {
    const auto end = [&](const std::optional<double>& value) { return value ? shown(*value, type) : "unknown"; };
    return fmt::format("{}, its 95 % interval {} to {}", shown(number.value, type), end(number.interval->low), end(number.interval->high));
  }
  const std::string_view name = number.name;
  const std::string_view key = name.substr(name.rfind('.') + 1);
  const bool is_percentile = key.size() == 3 && key[0] == 'p' && std::isdigit(static_cast<unsigned char>(key[1])) != 0;
  if (is_percentile || key.find("probability") != std::string_view::npos) {
    return fmt::format("the {} itself is compared: the answer has no interval for it", is_percentile ? "percentile" : "probability");
  }
  if (key == "time_to_limit_s") {
    return "the time of the nominal motor is compared";
  }
  return key == "nominal" ? "the nominal value is compared" : "";
}

/// Returns the width of the number's 95 % interval; 0 if it has none or it is unbounded.
double interval_width(const AnswerNumber& number) {
  const bool is_bounded = number.interval && number.interval->low && number.interval->high;
  return is_bounded ? *number.interval->high - *number.interval->low : 0.0;
}

/// Throws Failure if the limit is a percentage and one of the numbers is a count.
void require_share(const Limit& limit, const std::vector<AnswerNumber>& numbers) {
  const auto count = std::ranges::find(numbers, true, &AnswerNumber::is_whole);
  if (limit.type->is_share && count != numbers.end()) {
    const std::string_view words = to_string(limit.type->direction);
    throw base::Failure(base::ExitCode::bad_input,
                        fmt::format("\"{}\" is a percentage, but '{}' is a whole number, {:.0f}; expected {} and a number without unit, "
                                    "such as \"{} {:.0f}\"",
                                    limit.text, count->name, count->value, words, words, count->value));
  }
}

/// Does the same as numbers_at(); if there is none, but a threshold of that name, the reason says so.
std::vector<AnswerNumber> numbers_named(std::string_view name, const nlohmann::ordered_json& answer) {
  try {
    return numbers_at(answer, name);
  } catch (const base::Failure& failure) {
    if (find_threshold(name) == nullptr) {
      throw;
    }
    throw base::Failure(failure.code(), fmt::format("'{}' is a threshold, not a number of a command's answer; expected a check with robot, "
                                                    "duty or motor in place of the command (`heatsoak describe {}`)",
                                                    name, name));
  }
}

}  // namespace

std::string parse_number_limit(std::string_view name, std::string_view text, Limit& limit) {
  const std::string_view words = text.substr(std::min(text.find_first_not_of(" \t"), text.size()));
  const bool is_at_least = words.starts_with(to_string(Bound::at_least));
  if (!is_at_least && !words.starts_with(to_string(Bound::at_most))) {
    return fmt::format("\"{}\" is not a limit; expected at most or at least and a number with its unit, such as \"at most 5 K\"", text);
  }
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
  const std::vector<AnswerNumber> numbers = numbers_named(limit.type->name, answer);
  require_share(limit, numbers);
  const auto is_worse = [direction](const AnswerNumber& one, const AnswerNumber& other) {
    return direction == Bound::at_most ? worse_end(one, direction) > worse_end(other, direction)
                                       : worse_end(one, direction) < worse_end(other, direction);
  };
  const AnswerNumber& worst = *std::ranges::min_element(numbers, is_worse);
  for (const AnswerNumber& each : numbers) {
    if (each.unit != worst.unit) {
      throw base::Failure(base::ExitCode::cannot_answer,
                          fmt::format("'{}' and '{}' have different units; expected a limit for each", worst.name, each.name));
    }
  }
  set_type(limit, std::string(limit.type->name), worst.unit, direction, limit.type->is_share);
  const ParsedLimit parsed = parse_limit(limit.text, *limit.type);
  if (!parsed.problem.empty()) {
    throw base::Failure(base::ExitCode::bad_input, parsed.problem);
  }
  limit.value = parsed.value;
  // Only now: a fraction as the limit of a count is permitted, but --update writes none.
  set_type(limit, std::string(limit.type->name), worst.unit, direction, limit.type->is_share, worst.is_whole);
  const double value = worse_end(worst, direction);
  if (worst.interval && !std::isfinite(value)) {
    throw base::Failure(
        base::ExitCode::cannot_answer,
        fmt::format("the 95 % interval of '{}' has no {} end, because the answer rests on too few samples; expected more of "
                    "them (--samples of the command)",
                    worst.name, direction == Bound::at_most ? "upper" : "lower"));
  }
  const std::string compared = interval_text(worst, *limit.type);
  std::string detail = numbers.size() > 1 ? fmt::format("{}, of {} numbers", worst.name, numbers.size()) : std::string();
  detail += compared.empty() || detail.empty() ? compared : "; " + compared;
  const double origin_value = worst.unit == "degC" ? base::kSheetTemperature_C : 0.0;
  return {.value = value,
          .origin_value = origin_value,
          .detail = detail,
          .is_never = std::isinf(worst.value),
          .interval_width_value = interval_width(worst)};
}

}  // namespace heatsoak::check
