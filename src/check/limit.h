// A limit as a check file writes it: "at most 150 degC".
#pragma once

#include <string>
#include <string_view>

#include "check/threshold.h"

namespace heatsoak::check {

struct ParsedLimit {
  double value = 0.0;   ///< in the unit of the threshold
  std::string unit;     ///< as the user wrote it: "degC", "%", may be empty
  std::string problem;  ///< empty where `value` is good
};

/// Reads "at most 150 degC" or "at least 0.5 A"; the words must be those of the threshold's direction, the number finite and in its range.
ParsedLimit parse_limit(std::string_view text, const ThresholdType& type);

/// Returns why the limit `text` of `value` cannot gate this check, because it is looser than ThresholdType::loosest; empty if it can.
std::string looseness_problem(double value, std::string_view text, const ThresholdType& type, const Check& check);

/// How --update sets a limit: `measured` with `margin_share` of its distance to the origin added, rounded away from the value, so that the
/// value keeps the limit. Thresholds without room get the value itself. Returns the text in `unit`, "at most 158 degC".
std::string updated_limit(const Measured& measured, const ThresholdType& type, std::string_view unit, double margin_share);

/// "at most", "at least".
std::string_view to_string(Bound direction);

/// Whether `value` keeps the limit. NaN keeps none.
bool keeps(Bound direction, double value, double limit_value);

/// For people: "61.2 °C", "4.1 %", "12 kB", "3". NaN gives "–".
std::string shown(double value, const ThresholdType& type);

}  // namespace heatsoak::check
