// What a log can hold: the one table of quantities, and how the name of any other column tells its unit.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/parameter.h"

namespace heatsoak {

enum class QuantityKind {
  time,
  temperature,   ///< of a part of the motor, instantaneous at the row's time
  surroundings,  ///< a temperature that the motor does not make: ambient, coolant, driver, neighbour
  heat_input,    ///< current, speed, torque, voltage, power: stands for the interval that begins at the row's time
  signal         ///< anything else; can become a regressor
};
std::string_view to_string(QuantityKind kind);

/// One row of the table. Numbered ones stand for wheel_speed_rad_per_s_1, _2, …
struct QuantityType {
  std::string_view key;
  QuantityKind kind;
  std::string_view unit;  ///< UDUNITS text; "" is a pure number
  Range possible;         ///< in that unit; what lies outside is no measurement
  bool is_numbered;
  std::string_view meaning;
};
std::span<const QuantityType> quantity_types();

/// A channel's name, understood.
struct Quantity {
  std::string key;  ///< as the log names it
  QuantityKind kind = QuantityKind::signal;
  std::string unit;  ///< UDUNITS text; "" is a pure number
  Range possible;
  std::string meaning;  ///< empty where the table has no such quantity
};

/// The quantity of the table, or a free one whose name ends in a unit ("thrust_N", "flow_m3_per_s", "valve_ratio").
/// Nothing where the name tells no unit.
std::optional<Quantity> quantity_named(std::string_view key);

/// "did you mean" among the table's names, or nothing.
std::string nearest_quantity(std::string_view key);

}  // namespace heatsoak
