// Possible ranges of the numbers in a JSON answer, declared in the answer itself.
#pragma once

#include <cmath>
#include <initializer_list>
#include <utility>

#include "base/parameter.h"

namespace heatsoak::base {

/// Key of an object whose members are names of numbers: {"over_share": [0, 1], "rest_s": [0, null]}, in the unit of the name. A declaration
/// holds for every number of that name in its object and in the groups inside, and for all numbers of a group of that name. Null is no
/// bound.
inline constexpr const char* kNumberRanges = "ranges";

inline constexpr Range kShare = Range::between(0.0, 1.0);
inline constexpr Range kNotNegative = Range::non_negative();

/// Returns the answer, or an object of it, with the ranges of its numbers.
template <class Json>
Json with_ranges(Json object, std::initializer_list<std::pair<const char*, Range>> ranges) {
  const auto end = [](double value) { return std::isfinite(value) ? Json(value) : Json(); };
  Json declared = Json::object();
  for (const auto& [name, range] : ranges) {
    declared[name] = Json::array({end(range.low), end(range.high)});
  }
  object[kNumberRanges] = std::move(declared);
  return object;
}

}  // namespace heatsoak::base
