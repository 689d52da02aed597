// Declaration of a parameter. Loading, range checks, documentation, sampling and fitting all read it.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace heatsoak::base {

/// Interval in the parameter's unit; each end is open or closed, and may be infinite.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_is_open = false;
  bool high_is_open = false;

  [[nodiscard]] constexpr bool contains(double value) const {
    return (low_is_open ? value > low : value >= low) && (high_is_open ? value < high : value <= high);
  }
  static constexpr Range any() { return {}; }
  static constexpr Range positive() { return {0.0, std::numeric_limits<double>::infinity(), true, false}; }
  static constexpr Range at_least(double low) { return {low, std::numeric_limits<double>::infinity(), false, false}; }
  static constexpr Range non_negative() { return at_least(0.0); }
  static constexpr Range between(double low, double high) { return {low, high, false, false}; }
};

/// Formats a range for messages and documentation: "more than 0 W", "0 to 1", "any value".
std::string to_string(const Range& range, std::string_view unit);

/// One of the named options of a parameter that is not a number.
struct Choice {
  std::string_view name;  ///< name in a file
  std::string_view unit;  ///< unit of those parameters whose unit depends on this choice
  std::string_view meaning;
};

struct ParameterSpec {
  std::string_view key;
  std::string_view unit;  ///< UDUNITS text; "" is a pure number
  Range range;
  std::string_view meaning;
  /// If not empty, a file gives the name of one choice and the value is its index; never sampled, never fitted. Static storage.
  std::span<const Choice> choices = {};
  std::optional<std::size_t> unit_of = {};  ///< index of the choice parameter that decides this one's unit; empty: `unit` applies

  /// Returns whether the value is a share of something, for which files usually give a percentage.
  [[nodiscard]] constexpr bool is_share() const { return unit.empty() && choices.empty() && range.low >= 0.0 && range.high <= 1.0; }

  static constexpr ParameterSpec choice(std::string_view key, std::span<const Choice> choices, std::string_view meaning) {
    return {key, "", Range::between(0.0, static_cast<double>(choices.size() - 1)), meaning, choices};
  }
};

/// Returns the unit of parameter `place`. `values` holds the values of the parameters declared before it.
std::string_view unit_of(std::span<const ParameterSpec> specs, std::size_t place, std::span<const double> values);

}  // namespace heatsoak::base
