#include "check/limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

#include "base/quantity.h"
#include "base/unit_names.h"

namespace heatsoak::check {
namespace {

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  return first == std::string_view::npos ? std::string_view() : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Returns the unit behind the number; empty without a unit or a number.
std::string unit_behind(std::string_view quantity) {
  const std::string_view rest = trimmed(quantity);
  const char* const begin = rest.data() + (rest.starts_with('+') ? 1 : 0);
  double number = 0.0;
  const auto [end, error] = std::from_chars(begin, rest.data() + rest.size(), number);
  return error == std::errc::invalid_argument ? std::string()
                                              : std::string(trimmed(rest.substr(static_cast<std::size_t>(end - rest.data()))));
}

/// Returns whether a unit is unknown or cannot be converted. A temperature in place of a difference has a message of its own.
bool is_of_other_quantity(const std::string& unit, std::string_view wanted) {
  const std::string one = fmt::format("1 {}", unit);
  return !unit.empty() && !base::parse_quantity(one, wanted).ok() && !(wanted == "K" && base::parse_quantity(one, "degC").ok());
}

/// Converts a value; unchanged if `to` is empty. Callers that need a distance subtract two results, because temperature scales have
/// offsets.
double in_unit(double value, std::string_view from, std::string_view to) { return base::convert(value, from, to.empty() ? from : to); }

/// Returns the step of the third significant digit of a distance.
double step_of(double distance) { return std::pow(10.0, std::floor(std::log10(std::max(std::abs(distance), 1e-9))) - 2.0); }

/// --update counts a smaller distance of a value to its origin as this one, in the unit. Other units have no such distance, nor have
/// counts.
struct LeastDistance {
  std::string_view unit;  ///< empty: shares and other pure numbers
  double value;
};
constexpr std::array<LeastDistance, 3> kLeastDistances{{{"degC", 20.0}, {"A", 1.0}, {"", 0.02}}};

double least_distance_value(const ThresholdType& type) {
  const auto found = std::ranges::find(kLeastDistances, type.unit, &LeastDistance::unit);
  return found == kLeastDistances.end() || type.is_whole ? 0.0 : found->value;
}

/// Rounds to a multiple of `step`, up or down. Rounding errors do not count: 150.0000000001 gives 150.
double rounded_away(double value, double step, bool is_up) {
  constexpr double kRounding = 1e-9;
  return is_up ? step * std::ceil(value / step - kRounding) : step * std::floor(value / step + kRounding);
}

}  // namespace

std::string_view to_string(Bound direction) { return direction == Bound::at_most ? "at most" : "at least"; }

bool keeps(Bound direction, double value, double limit_value) {
  return direction == Bound::at_most ? value <= limit_value : value >= limit_value;
}

std::vector<std::string> units_of_quantity(std::optional<std::string_view> unit) {
  std::vector<std::string> units;
  if (unit) {
    units.emplace_back(*unit);
  }
  const bool is_angular = !unit || unit->find("rad") != std::string_view::npos || *unit == "rpm" || *unit == "deg";
  for (const base::UnitWord& each : base::kUnitWords) {
    const bool is_listed = each.unit.empty() || (unit && (*unit == each.unit || *unit == "degC"));
    // UDUNITS takes an angle for a pure number, so it converts it to a byte.
    if (!is_listed && (each.si.rad == 0 || is_angular) && (!unit || base::parse_quantity(fmt::format("1 {}", each.unit), *unit).ok())) {
      units.emplace_back(each.unit);
    }
  }
  return units;
}

ParsedLimit parse_limit(std::string_view text, const ThresholdType& type) {
  using Kind = LimitProblem::Kind;
  const std::string_view all = trimmed(text);
  const auto problem = [all](Kind kind, double value = 0.0) { return ParsedLimit{.problem = LimitProblem{kind, std::string(all), value}}; };
  const std::string_view words = to_string(type.direction);
  if (all.starts_with(to_string(type.direction == Bound::at_most ? Bound::at_least : Bound::at_most))) {
    return problem(Kind::wrong_side);
  }
  if (!all.starts_with(words) || (all.size() > words.size() && all[words.size()] != ' ')) {
    return problem(base::parse_quantity(all, type.unit, type.is_share).ok() ? Kind::lacks_words : Kind::no_limit);
  }
  const std::string_view quantity = trimmed(all.substr(words.size()));
  const base::ParsedQuantity parsed = base::parse_quantity(quantity, type.unit, type.is_share);
  const std::string unit = unit_behind(quantity);
  if (!parsed.ok()) {
    const bool is_other = is_of_other_quantity(unit, type.unit);
    ParsedLimit none = problem(is_other ? Kind::other_unit : Kind::no_quantity);
    none.problem->quantity_problem = parsed.problem;
    none.problem->unit = unit;
    if (is_other && !type.unit.empty()) {
      none.problem->units = units_of_quantity(type.unit);
    }
    return none;
  }
  if (type.unit == "degC" && unit == "K") {
    ParsedLimit none = problem(Kind::absolute_temperature, parsed.value);
    const bool is_meant = type.range.contains(parsed.value);
    none.problem->number = is_meant ? base::significant(parsed.value, 6) : trimmed(quantity.substr(0, quantity.size() - 1));
    return none;
  }
  if (!type.range.contains(parsed.value)) {
    return problem(Kind::out_of_range, parsed.value);
  }
  if (type.is_whole && parsed.value != std::floor(parsed.value)) {
    return problem(Kind::fraction_of_count, parsed.value);
  }
  return {parsed.value, unit};
}

std::string unit_of_limit(std::string_view text) {
  const std::string_view all = trimmed(text);
  const std::size_t words = to_string(all.starts_with(to_string(Bound::at_least)) ? Bound::at_least : Bound::at_most).size();
  return unit_behind(all.substr(std::min(all.size(), words)));
}

std::optional<Looseness> looseness(double value, std::string_view text, const ThresholdType& type, const Check& check) {
  const std::optional<LoosestLimit> loosest = type.loosest != nullptr ? type.loosest(check) : std::nullopt;
  if (!loosest) {
    return std::nullopt;
  }
  // The slack absorbs rounding errors: 99.9 % in a file is not exactly 0.999.
  constexpr double kRounding = 1e-9;
  const double slack = kRounding * (type.direction == Bound::at_most ? 1.0 : -1.0);
  const bool is_permitted = !loosest->refusal && keeps(type.direction, value, loosest->value + (loosest->always_holds ? -slack : slack));
  return is_permitted ? std::nullopt : std::optional(Looseness{std::string(text), *loosest});
}

std::string updated_limit(const Measured& measured, const ThresholdType& type, std::string_view unit, double margin_share) {
  const bool is_up = type.direction == Bound::at_most;
  const auto text_of = [&](double value) {
    return fmt::format("{} {}{}{}", to_string(type.direction), base::significant(value, 6), unit.empty() ? "" : " ", unit);
  };
  if (type.room == Room::none) {
    return text_of(in_unit(measured.value, type.unit, unit));
  }
  const double room =
      margin_share * std::max({std::abs(measured.value - measured.origin_value), least_distance_value(type), measured.interval_width_value});
  const double limit = in_unit(is_up ? measured.value + room : measured.value - room, type.unit, unit);
  const double step = type.is_whole ? 1.0 : step_of(limit - in_unit(measured.origin_value, type.unit, unit));
  const auto end_of_range = [&](double value) { return std::isfinite(value) ? in_unit(value, type.unit, unit) : value; };
  const double least = end_of_range(type.range.low);
  const double most = end_of_range(type.range.high);
  const double rounded = rounded_away(limit, step, is_up);
  std::string text = text_of(std::clamp(rounded, least, most));
  // With little room, the rounding to six digits may put the limit on the wrong side of the value.
  if (!keeps(type.direction, measured.value, parse_limit(text, type).value)) {
    text = text_of(std::clamp(is_up ? rounded + step : rounded - step, least, most));
  }
  return text;
}

std::string shown(double value, const ThresholdType& type) {
  if (!std::isfinite(value)) {
    return value > 0.0 ? "never" : "–";
  }
  if (type.unit.empty() && type.is_share) {
    return base::significant(100.0 * value, 3) + " %";
  }
  if (type.unit == "degC") {
    return fmt::format("{:.1f} °C", value);
  }
  if (type.unit == "byte") {
    return fmt::format("{:.1f} kB", 1e-3 * value);
  }
  const std::string number = std::abs(value) < 1e-12 ? "0" : base::significant(value, 3);
  return type.unit.empty() ? number : fmt::format("{} {}", number, base::unit_for_display(type.unit));
}

}  // namespace heatsoak::check
