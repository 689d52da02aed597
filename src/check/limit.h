// Limits in the notation of check files: "at most 150 degC".
#pragma once

#include <string>
#include <string_view>

#include "check/threshold.h"

namespace heatsoak::check {

struct ParsedLimit {
  double value = 0.0;   ///< in the unit of the threshold
  std::string unit;     ///< unit as the user wrote it: "degC", "%"; may be empty
  std::string problem;  ///< empty if `value` is valid
};

/// Parses "at most 150 degC" or "at least 0.5 A". The words must be those of the threshold's direction, the number finite and in its range.
ParsedLimit parse_limit(std::string_view text, const ThresholdType& type);

/// Returns the unit of a limit's text: "degC" of "at most 150 degC"; empty without a unit.
std::string unit_of_limit(std::string_view text);

/// Returns the problem of a limit that is written as a number without words, quotes and unit.
std::string bare_limit_problem(std::string_view number, const ThresholdType& type);

/// A limit that is looser than ThresholdType::loosest permits.
struct Looseness {
  std::string text;  ///< text of the limit
  LoosestLimit loosest;
};
/// Returns nothing if the limit `text` of `value` is permitted in this check.
std::optional<Looseness> looseness(double value, std::string_view text, const ThresholdType& type, const Check& check);
/// Returns the origin: "the motor's own winding limit".
std::string_view words_of(LoosestBy origin);
/// Returns the problem of that limit in a check file.
std::string problem_of(const Looseness& found, const ThresholdType& type);

/// Returns the limit that --update writes, in `unit`: "at most 158 degC". It lies beyond `measured` by `margin_share` of the value's
/// distance to its origin, and is rounded so that the value keeps it. Thresholds without room get the value itself.
std::string updated_limit(const Measured& measured, const ThresholdType& type, std::string_view unit, double margin_share);

/// Returns "at most" or "at least".
std::string_view to_string(Bound direction);

/// Returns whether `value` keeps the limit; false for NaN.
bool keeps(Bound direction, double value, double limit_value);

/// Formats a value with its unit for people: "61.2 °C", "4.1 %", "12 kB", "3"; "never" for an infinite time, "–" for NaN.
std::string shown(double value, const ThresholdType& type);

}  // namespace heatsoak::check
