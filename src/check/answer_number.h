// Numbers of a JSON answer by their place: "planners.time_optimal.distance_m", "motors.*.winding_peak_C.p95".
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace heatsoak::check {

struct AnswerInterval {
  double low = 0.0;
  double high = 0.0;
};

struct AnswerNumber {
  std::string name;  ///< place in the answer
  double value = 0.0;
  std::string unit;                             ///< UDUNITS text; "" is a pure number
  std::optional<AnswerInterval> interval = {};  ///< 95 % interval that the answer gives beside the number
};

/// Returns the numbers at a place: keys joined by ".". An element of a list is named by the value of its first key, its id, name or index,
/// or if it has none by its place from 0. "*" is every key or element. Throws Failure with the present names if nothing is there, or if
/// something else than a number is.
std::vector<AnswerNumber> numbers_at(const nlohmann::ordered_json& answer, std::string_view place);

/// Returns the unit in which a name ends: "K/W" of "resistance_K_per_W"; empty if it ends in none.
std::string unit_of_name(std::string_view name);

}  // namespace heatsoak::check
