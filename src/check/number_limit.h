// Limits on numbers of a command's JSON answer, in the notation of the thresholds.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "check/check_file.h"

namespace heatsoak::check {

/// Threshold of one number, with the texts that ThresholdType refers to.
struct NumberType {
  std::string name;
  std::string unit;
  std::string example;
  ThresholdType type;
};

/// Parses "at most 5 m" or "at least 90 %" for the number `name`, in the unit of the text. Returns a problem, or an empty text and `limit`
/// without its place.
std::string parse_number_limit(std::string_view name, std::string_view text, Limit& limit);

/// Returns the number of the answer that the limit names; of several, the one that is nearest to violating it, and of a number with a 95 %
/// interval its worse end. Converts the limit to the unit of the answer. Throws NotEvaluated if there is no such number, or if its
/// unit is another one.
Measured measure_number(Limit& limit, const nlohmann::ordered_json& answer);

}  // namespace heatsoak::check
