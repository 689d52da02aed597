// One statement of a parameter, read by loading, range checks, documentation, sampling, fitting.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <string_view>

namespace heatsoak {

/// Open or closed interval in the parameter's unit.
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
  static constexpr Range non_negative() { return {0.0, std::numeric_limits<double>::infinity(), false, false}; }
  static constexpr Range between(double low, double high) { return {low, high, false, false}; }
};

/// "a positive value", "0 … 1": for messages and documentation.
std::string to_string(const Range& range, std::string_view unit);

/// One of the things that a parameter may name instead of a number.
struct Choice {
  std::string_view name;  ///< as a file has it
  std::string_view unit;  ///< of the parameters that take theirs from this choice
  std::string_view meaning;
};

struct ParameterSpec {
  std::string_view key;
  std::string_view unit;  ///< UDUNITS text; "" is a pure number
  Range range;
  std::string_view meaning;
  /// Where there are any, a file has one of their names and the value is its place; never sampled, never fitted. Static.
  std::span<const Choice> choices = {};
  int unit_of = -1;  ///< place of the choice among the parameters whose unit this one takes

  static constexpr ParameterSpec choice(std::string_view key, std::span<const Choice> choices, std::string_view meaning) {
    return {key, "", Range::between(0.0, static_cast<double>(choices.size() - 1)), meaning, choices};
  }
};

/// The unit of parameter `place`, given the values of those declared before it.
std::string_view unit_of(std::span<const ParameterSpec> specs, std::size_t place, std::span<const double> values);

}  // namespace heatsoak
