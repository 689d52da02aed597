// Numbers of a JSON answer by their place: "planners.time_optimal.distance_m", "motors.*.winding_peak_C.p95".
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/parameter.h"
#include "check/basis.h"

namespace heatsoak::check {

struct AnswerNumber {
  std::string name;                             ///< place in the answer
  double value = 0.0;                           ///< infinite for a time that never comes: null of a key in the list `never` beside it
  std::string unit;                             ///< UDUNITS text; "" is a pure number
  bool is_whole = false;                        ///< an integer of the answer: a count or an index, which is no share
  std::optional<AnswerInterval> interval = {};  ///< 95 % interval that the answer gives beside the number
  base::Range possible = {};                    ///< declared by the answer (base/number_ranges.h); an integer is never negative
};

/// Returns the numbers at a place: keys joined by ".". An element of a list is named by the value of its first key, its id, name or index,
/// or if it has none by its place from 0. "*" is every key or element. Throws NotEvaluated if nothing is there, or if something else
/// than a number is.
std::vector<AnswerNumber> numbers_at(const nlohmann::ordered_json& answer, std::string_view place);

}  // namespace heatsoak::check
