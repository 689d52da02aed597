#include "base/parameter.h"

#include <fmt/format.h>

#include <cmath>

#include "base/quantity.h"

namespace heatsoak::base {

std::string to_string(const Range& range, std::string_view unit) {
  const auto with_unit = [unit](double value) {
    constexpr double kLargestInDigits = 1e7;
    const std::string number = std::abs(value) > kLargestInDigits ? fmt::format("{:.6g}", value) : significant(value, 6);
    return unit.empty() ? number : fmt::format("{} {}", number, unit_for_display(unit));
  };
  const bool below = std::isfinite(range.high);
  if (!std::isfinite(range.low)) {
    return below ? fmt::format("{} {}", range.high_is_open ? "below" : "at most", with_unit(range.high)) : "any value";
  }
  if (!below) {
    return fmt::format("{} {}", range.low_is_open ? "more than" : "at least", with_unit(range.low));
  }
  if (range.low_is_open || range.high_is_open) {
    return fmt::format("{} {} and {} {}", range.low_is_open ? "more than" : "at least", with_unit(range.low),
                       range.high_is_open ? "below" : "at most", with_unit(range.high));
  }
  return fmt::format("{} to {}", with_unit(range.low), with_unit(range.high));
}

std::string_view unit_of(std::span<const ParameterSpec> specs, std::size_t place, std::span<const double> values) {
  const std::optional<std::size_t> decided_by = specs[place].unit_of;
  return decided_by ? specs[*decided_by].choices[static_cast<std::size_t>(values[*decided_by])].unit : specs[place].unit;
}

}  // namespace heatsoak::base
