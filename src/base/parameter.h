// One statement of a parameter, read by loading, range checks, documentation, sampling, fitting.
#pragma once

#include <limits>
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

struct ParameterSpec {
  std::string_view key;
  std::string_view unit;  ///< UDUNITS text; "" is a pure number
  Range range;
  std::string_view meaning;
};

}  // namespace heatsoak
