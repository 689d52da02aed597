#include "check/limit_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/quantity.h"

namespace heatsoak::check {
namespace {

std::string expected(const ThresholdType& type) {
  return fmt::format("expected {} and a value, such as \"{}\"", to_string(type.direction), type.example);
}

}  // namespace

std::string words_of(const LimitProblem& problem, const ThresholdType& type) {
  switch (problem.kind) {
    case LimitProblem::Kind::wrong_side:
      return fmt::format("\"{}\" limits the wrong side of {}; {}", problem.text, type.name, expected(type));
    case LimitProblem::Kind::no_limit:
      return fmt::format("\"{}\" is not a limit; {}", problem.text, expected(type));
    case LimitProblem::Kind::lacks_words:
      return fmt::format("\"{0}\" is not a limit; expected \"{1} {0}\"", problem.text, to_string(type.direction));
    case LimitProblem::Kind::no_quantity:
      return fmt::format("{} (\"{}\")", problem.quantity_problem, type.example);
    case LimitProblem::Kind::other_unit:
      return problem.units.empty() ? fmt::format("'{}' is no unit of {}, which is a pure number; expected a limit such as \"{}\"",
                                                 problem.unit, type.name, type.example)
                                   : fmt::format("'{}' is no unit of {}; expected {}{}", problem.unit, type.name,
                                                 problem.units.size() > 1 ? "one of " : "", fmt::join(problem.units, ", "));
    case LimitProblem::Kind::absolute_temperature:
      return fmt::format("\"{}\" is an absolute temperature, {:.0f} °C; expected \"{} {} degC\" if that is meant", problem.text,
                         problem.value, to_string(type.direction), problem.number);
    case LimitProblem::Kind::out_of_range:
      return type.is_share ? fmt::format("\"{}\" is {} %; expected 0 to 100 %, such as \"{}\"", problem.text,
                                         base::significant(100.0 * problem.value, 6), type.example)
                           : fmt::format("\"{}\" is out of range; expected {}, such as \"{}\"", problem.text,
                                         base::to_string(type.range, type.unit), type.example);
    case LimitProblem::Kind::fraction_of_count:
      return fmt::format("\"{}\" is not a whole number; {}", problem.text, expected(type));
  }
  return {};
}

std::string bare_limit_problem(std::string_view number, const ThresholdType& type) {
  // A share may be meant in percent or not, so the number cannot be taken over.
  const std::string expected = type.is_share
                                   ? std::string(type.example)
                                   : fmt::format("{} {}{}{}", to_string(type.direction), number, type.unit.empty() ? "" : " ", type.unit);
  return fmt::format("{} is a bare number; expected a limit as text, such as \"{}\"", number, expected);
}

std::string_view words_of(LoosestBy origin) {
  switch (origin) {
    case LoosestBy::winding_limit:
      return "the motor's own winding limit";
    case LoosestBy::stator_limit:
      return "the motor's own stator limit";
    case LoosestBy::winding_limit_of_stator:
      return "the motor's own winding limit, which the stator must not exceed either";
    case LoosestBy::own_limits:
      return "the motor's own limits";
    case LoosestBy::driver_limit:
      return "the current limit of the robot's driver";
    case LoosestBy::whole_charge:
      return "the largest current of all wheels during the whole duty";
    case LoosestBy::duty_duration:
      return "the duration of the duty";
    case LoosestBy::half_match:
      return "half of the match";
    case LoosestBy::temperature_range:
      return "the motor's range from the air to its winding limit";
    case LoosestBy::motors_against:
      return "the number of motors in 'against'";
    case LoosestBy::values_of_files:
      return "the number of values in a complete motor file, for every file";
    case LoosestBy::largest_core:
      return "twice the code of the drive core with the largest guard table";
    case LoosestBy::largest_share:
      return "the largest share that a limit may permit";
    case LoosestBy::smallest_value:
      return "the smallest possible value";
  }
  return {};
}

std::string words_of(const Looseness& found, const ThresholdType& type) {
  const LoosestLimit& loosest = found.loosest;
  if (loosest.refusal) {
    return fmt::format(
        "counts only above the motor's own winding limit: 'temperature' is {:.1f} °C, the limit {:.1f} °C; expected a 'temperature' up to "
        "that limit",
        loosest.refusal->temperature_C, loosest.refusal->winding_limit_C);
  }
  if (loosest.always_holds) {
    return fmt::format("\"{}\" holds always: {} is {}; expected a tighter limit", found.text, words_of(loosest.origin),
                       shown(loosest.value, type));
  }
  return fmt::format("\"{}\" is looser than {}, {}; expected that or a tighter limit", found.text, words_of(loosest.origin),
                     shown(loosest.value, type));
}

}  // namespace heatsoak::check
