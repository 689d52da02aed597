// Quantities of a log: the table of known ones, and how the unit follows from the name of any other column.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/parameter.h"
#include "base/signals.h"

namespace heatsoak::recording {

using base::QuantityKind;
std::string_view to_string(QuantityKind kind);

/// One row of the table: a column of base::kSignals, or one that only logs have. A numbered quantity has one column per number:
/// wheel_speed_rad_per_s_1, _2, …
struct QuantityType {
  std::string_view key;
  QuantityKind kind;
  std::string_view unit;  ///< UDUNITS text; "" is a pure number
  base::Range possible;   ///< in that unit; values outside are invalid
  bool is_numbered;
  std::string_view meaning;
  std::string_view alias = {};  ///< earlier name, which logs and mappings may still use
};
std::span<const QuantityType> quantity_types();

/// Returns the column of a canonical log from which a signal is read; for the shaft power this is the torque.
constexpr std::string_view column_of(base::Signal signal) { return base::row_of(signal).column; }
/// Column with the temperature of the air around the motor.
inline constexpr std::string_view kAmbientColumn = base::kSignals[base::signal_row("ambient")].column;

/// Heat inputs that checks of a log use as a measure of its heat, most direct first. Other columns of QuantityKind::heat_input, such as
/// motor_d_V or power_out_W, say less about the heat and are not used for this.
inline constexpr std::array<std::string_view, 9> kHeatColumns{
    column_of(base::Signal::current),     "current_q_A", column_of(base::Signal::input_power), "bus_A",
    column_of(base::Signal::shaft_power), "motor_V",     column_of(base::Signal::modulation),  column_of(base::Signal::bus_voltage),
    column_of(base::Signal::speed)};
/// The first ones heat the winding before the iron. Voltages and speed can act without load, and then heat the iron.
inline constexpr std::size_t kWindingHeatColumns = 5;
/// The first ones imply that no heat is produced where they are 0. Supply voltage and speed do not: a current may flow at standstill.
inline constexpr std::size_t kHeatColumnsZeroAtRest = 7;

/// Quantity of a channel, derived from its name.
struct Quantity {
  std::string key;  ///< name in the table, or of the column
  QuantityKind kind = QuantityKind::signal;
  std::string unit;  ///< UDUNITS text; "" is a pure number
  base::Range possible;
  std::string meaning;  ///< empty if the table does not have it
};

/// Returns the quantity from the table, also for an alias, or a free one whose name ends in a unit ("thrust_N", "flow_kg_per_s",
/// "valve_ratio"). nullopt if the name does not end in a unit.
std::optional<Quantity> quantity_named(std::string_view key);

/// Returns the name in the table for an alias, with its number; any other key as it is.
std::string canonical_key(std::string_view key);
/// Inverse of canonical_key(), for values derived from names before they had an alias.
std::string earlier_key(std::string_view key);

/// Returns a "did you mean" hint with the nearest name of the table, or an empty string.
std::string nearest_quantity(std::string_view key);

}  // namespace heatsoak::recording
