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
#include "base/unit_names.h"
#include "check/answer_number.h"
#include "check/limit.h"
#include "check/limit_words.h"
#include "check/not_evaluated.h"
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

/// Returns the last key of the number's place.
std::string_view key_of(const AnswerNumber& number) { return std::string_view(number.name).substr(number.name.rfind('.') + 1); }

/// Narrows the limit to what --update may write: a limit at the end of the possible range cannot fail.
void set_possible(Limit& limit, const base::Range& possible) {
  const auto own = std::make_shared<NumberType>(*limit.own);
  own->type.name = own->name;
  own->type.unit = own->unit;
  own->type.example = own->example;
  own->type.range = possible;
  if (own->type.direction == Bound::at_least && possible.low == 0.0) {
    own->type.loosest = [](const Check&) -> std::optional<LoosestLimit> { return LoosestLimit{0.0, LoosestBy::smallest_value, true}; };
  } else if (own->type.direction == Bound::at_most && possible.high == 1.0) {
    own->type.loosest = [](const Check&) -> std::optional<LoosestLimit> { return largest_share_limit(); };
  }
  limit.type = &own->type;
  limit.own = own;
}

Compared compared_part(const AnswerNumber& number) {
  if (number.interval) {
    return Compared::interval;
  }
  const std::string_view key = key_of(number);
  if (key.size() == 3 && key[0] == 'p' && std::isdigit(static_cast<unsigned char>(key[1])) != 0) {
    return Compared::percentile;
  }
  if (key.find("probability") != std::string_view::npos) {
    return Compared::probability;
  }
  return key == "time_to_limit_s" ? Compared::nominal_time : key == "nominal" ? Compared::nominal : Compared::number;
}

/// Returns the width of the number's 95 % interval; 0 if it has none or it is unbounded.
double interval_width(const AnswerNumber& number) {
  const bool is_bounded = number.interval && number.interval->low && number.interval->high;
  return is_bounded ? *number.interval->high - *number.interval->low : 0.0;
}

/// Throws NotEvaluated if the limit is a percentage and one of the numbers is a count.
void require_share(const Limit& limit, const std::vector<AnswerNumber>& numbers) {
  const auto count = std::ranges::find(numbers, true, &AnswerNumber::is_whole);
  if (limit.type->is_share && count != numbers.end()) {
    throw NotEvaluated(NumberIsCount{count->name, count->value});
  }
}

/// Does the same as numbers_at(); if there is none, but a threshold of that name, the reason says so.
std::vector<AnswerNumber> numbers_named(std::string_view name, const nlohmann::ordered_json& answer) {
  try {
    return numbers_at(answer, name);
  } catch (const NotEvaluated&) {
    if (find_threshold(name) == nullptr) {
      throw;
    }
    throw NotEvaluated(NumberIsThreshold{std::string(name)});
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
  ParsedLimit parsed = parse_limit(text, *limit.type);
  if (parsed.problem && parsed.problem->kind == LimitProblem::Kind::other_unit) {
    // No unit at all. The answer declares the number's unit, which is not known yet; its name mostly ends in it.
    const std::optional<base::UnitOfName> declared = base::unit_of_name(name.substr(name.rfind('.') + 1));
    parsed.problem->units = units_of_quantity(declared ? std::optional<std::string_view>(declared->unit) : std::nullopt);
  }
  limit.value = parsed.value;
  limit.unit = parsed.unit;
  limit.text = text;
  return parsed.problem ? words_of(*parsed.problem, *limit.type) : "";
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
      throw NotEvaluated(UnitsDiffer{worst.name, each.name});
    }
  }
  set_type(limit, std::string(limit.type->name), worst.unit, direction, limit.type->is_share);
  const ParsedLimit parsed = parse_limit(limit.text, *limit.type);
  if (parsed.problem) {
    throw NotEvaluated(LimitInvalid{*parsed.problem});
  }
  limit.value = parsed.value;
  // Only now: a limit that cannot fail, or a fraction as the limit of a count, is permitted, but --update writes none.
  set_type(limit, std::string(limit.type->name), worst.unit, direction, limit.type->is_share, worst.is_whole);
  if (std::isfinite(worst.possible.low) || std::isfinite(worst.possible.high)) {
    set_possible(limit, worst.possible);
  }
  const double value = worse_end(worst, direction);
  if (worst.interval && !std::isfinite(value)) {
    throw NotEvaluated(IntervalUnbounded{worst.name});
  }
  return {.value = value,
          .origin_value = worst.unit == "degC" ? base::kSheetTemperature_C : 0.0,
          .basis = NumberBasis{.name = worst.name,
                               .numbers = numbers.size(),
                               .compared = compared_part(worst),
                               .value = worst.value,
                               .interval = worst.interval.value_or(AnswerInterval())},
          .is_never = std::isinf(worst.value),
          .interval_width_value = interval_width(worst)};
}

}  // namespace heatsoak::check
