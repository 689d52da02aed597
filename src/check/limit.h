// Limits in the notation of check files: "at most 150 degC".
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "check/threshold.h"

namespace heatsoak::check {

/// Text that is no valid limit.
struct LimitProblem {
  enum class Kind {
    wrong_side,            ///< "at least" for a value that has an upper limit, or the reverse
    no_limit,              ///< it does not begin with "at most" or "at least"
    lacks_words,           ///< it is a quantity alone
    no_quantity,           ///< `quantity_problem` says why
    other_unit,            ///< `unit` is none, or that of another quantity
    absolute_temperature,  ///< a temperature in kelvin, where a difference was probably meant
    out_of_range,
    fraction_of_count,
  };
  Kind kind = Kind::no_limit;
  std::string text;                     ///< the whole text, without spaces around it
  double value = 0.0;                   ///< in the unit of the threshold, if the text is a quantity
  std::string number = {};              ///< for `absolute_temperature`: the number as written
  std::string quantity_problem = {};    ///< ParsedQuantity::problem
  std::string unit = {};                ///< for `other_unit`: as written
  std::vector<std::string> units = {};  ///< for `other_unit`: those of the quantity; empty for a pure number
};

struct ParsedLimit {
  double value = 0.0;                        ///< in the unit of the threshold
  std::string unit = {};                     ///< unit as the user wrote it: "degC", "%"; may be empty
  std::optional<LimitProblem> problem = {};  ///< nothing if `value` is valid
};

/// Returns the units in which a limit of a quantity can be written, prefixes aside: "s", "h", "min" … for "s"; all that this program has
/// for an unknown quantity, without `unit`. A temperature has degC alone, because one in K is mostly a difference.
std::vector<std::string> units_of_quantity(std::optional<std::string_view> unit);

/// Parses "at most 150 degC" or "at least 0.5 A". The words must be those of the threshold's direction, the number finite and in its range.
ParsedLimit parse_limit(std::string_view text, const ThresholdType& type);

/// Returns the unit of a limit's text: "degC" of "at most 150 degC"; empty without a unit.
std::string unit_of_limit(std::string_view text);

/// A limit that is looser than ThresholdType::loosest permits.
struct Looseness {
  std::string text;  ///< text of the limit
  LoosestLimit loosest;
};
/// Returns nothing if the limit `text` of `value` is permitted in this check.
std::optional<Looseness> looseness(double value, std::string_view text, const ThresholdType& type, const Check& check);

/// Returns the limit that --update writes, in `unit`: "at most 158 degC". It lies beyond `measured` by `margin_share` of the value's
/// distance to its origin, at least of 20 K, of 1 A, or of 0.02 for a pure number that is no count, and is rounded so that the value keeps
/// it. Thresholds without room get the value itself.
std::string updated_limit(const Measured& measured, const ThresholdType& type, std::string_view unit, double margin_share);

/// Returns "at most" or "at least".
std::string_view to_string(Bound direction);

/// Returns whether `value` keeps the limit; false for NaN.
bool keeps(Bound direction, double value, double limit_value);

/// Formats a value with its unit for people: "61.2 °C", "4.1 %", "12 kB", "3"; "never" for an infinite time, "–" for NaN.
std::string shown(double value, const ThresholdType& type);

}  // namespace heatsoak::check
