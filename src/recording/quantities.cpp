#include "recording/quantities.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

#include "base/diagnostic.h"
#include "base/quantity.h"
#include "base/unit_names.h"

namespace heatsoak::recording {
namespace {

using Kind = QuantityKind;

constexpr base::Range kTemperature_C = base::Range::between(-100.0, 1000.0);
constexpr base::Range kAny = base::Range::any();
/// Valid for all units; larger values would make squares and sums meaningless.
constexpr base::Range kHeatInput = base::Range::between(-1e12, 1e12);

/// Columns that are no signals of base::kSignals.
constexpr std::array kOfLogs{
    QuantityType{"time_s", Kind::time, "s", kAny, false, "time of the row; any origin, strictly increasing"},
    QuantityType{"winding_C", Kind::temperature, "degC", kTemperature_C, false, "temperature of the winding"},
    QuantityType{"stator_C", Kind::temperature, "degC", kTemperature_C, false, "temperature of the stator (iron, or the motor's outside)"},
    QuantityType{"housing_C", Kind::temperature, "degC", kTemperature_C, false, "temperature of a housing around the stator"},
    QuantityType{"tooth_C", Kind::temperature, "degC", kTemperature_C, false, "temperature of a stator tooth"},
    QuantityType{"magnet_C", Kind::temperature, "degC", kTemperature_C, false, "temperature of the rotor's magnets"},
    QuantityType{"coolant_C", Kind::surroundings, "degC", kTemperature_C, false, "temperature of a cooling liquid"},
    QuantityType{"driver_C", Kind::surroundings, "degC", kTemperature_C, false, "temperature of the motor's driver"},
    QuantityType{"current_d_A", Kind::heat_input, "A", kHeatInput, false, "field-producing current, peak of a phase"},
    QuantityType{"current_q_A", Kind::heat_input, "A", kHeatInput, false, "torque-producing current, peak of a phase"},
    QuantityType{"motor_V", Kind::heat_input, "V", kHeatInput, false, "voltage at the motor's terminals, with sign"},
    QuantityType{"motor_d_V", Kind::heat_input, "V", kHeatInput, false, "voltage along the field"},
    QuantityType{"motor_q_V", Kind::heat_input, "V", kHeatInput, false, "voltage across the field"},
    QuantityType{"bus_A", Kind::heat_input, "A", kHeatInput, false, "current from the supply into the driver"},
    QuantityType{"power_out_W", Kind::heat_input, "W", kHeatInput, false, "mechanical power at the shaft"},
    QuantityType{"battery_V", Kind::signal, "V", kAny, false, "voltage of the robot's battery"},
    QuantityType{"heading_rad", Kind::signal, "rad", kAny, false, "direction of travel in the robot's frame, 0 is ahead, anticlockwise"},
    QuantityType{"vx_m_per_s", Kind::signal, "m/s", kAny, false, "measured velocity ahead, robot's frame"},
    QuantityType{"vy_m_per_s", Kind::signal, "m/s", kAny, false, "measured velocity to the left, robot's frame"},
    QuantityType{"yaw_rate_rad_per_s", Kind::signal, "rad/s", kAny, false, "measured turning rate, anticlockwise"},
    QuantityType{"vx_set_m_per_s", Kind::signal, "m/s", kAny, false, "demanded velocity ahead, robot's frame"},
    QuantityType{"vy_set_m_per_s", Kind::signal, "m/s", kAny, false, "demanded velocity to the left, robot's frame"},
    QuantityType{"yaw_rate_set_rad_per_s", Kind::signal, "rad/s", kAny, false, "demanded turning rate, anticlockwise"},
    QuantityType{"x_m", Kind::signal, "m", kAny, false, "position on the field"},
    QuantityType{"y_m", Kind::signal, "m", kAny, false, "position on the field"},
    QuantityType{"yaw_rad", Kind::signal, "rad", kAny, false, "orientation on the field, anticlockwise from x to y"},
    QuantityType{"wheel_speed_rad_per_s", Kind::signal, "rad/s", kAny, true, "speed of a wheel's motor shaft"},
    QuantityType{"wheel_speed_set_rad_per_s", Kind::signal, "rad/s", kAny, true, "demanded speed of a wheel's motor shaft"},
    QuantityType{"wheel_angle_rad", Kind::signal, "rad", kAny, true, "angle of a wheel's motor shaft, counted on over turns"},
    QuantityType{"wheel_current_A", Kind::signal, "A", kAny, true, "current of a wheel's motor"},
    QuantityType{"wheel_voltage_V", Kind::signal, "V", kAny, true, "voltage at a wheel's motor, with sign"},
    QuantityType{"wheel_modulation_ratio", Kind::signal, "", kAny, true, "modulation of a wheel's driver, -1 … 1", "wheel_pwm_ratio"},
    QuantityType{"wheel_winding_C", Kind::temperature, "degC", kTemperature_C, true, "temperature of the winding of a wheel's motor"},
    QuantityType{"wheel_stator_C", Kind::temperature, "degC", kTemperature_C, true, "temperature of the stator of a wheel's motor"},
};

constexpr base::Range range_of(Kind kind, std::string_view unit) {
  return unit == "degC" ? kTemperature_C : kind == Kind::heat_input ? kHeatInput : kAny;
}

constexpr std::size_t kSignalColumns =
    std::ranges::count_if(base::kSignals, [](const base::SignalRow& row) { return !row.column.empty(); });

constexpr std::array kTypes = [] {
  std::array<QuantityType, kOfLogs.size() + kSignalColumns> types{};
  auto next = std::ranges::copy(kOfLogs, types.begin()).out;
  for (const base::SignalRow& row : base::kSignals) {
    if (!row.column.empty()) {
      const std::string_view unit = row.column_unit.empty() ? row.unit : row.column_unit;
      *next++ = {row.column, row.column_kind, unit, range_of(row.column_kind, unit), false, row.column_meaning, row.column_alias};
    }
  }
  return types;
}();

std::string_view without_number(std::string_view key) {
  const std::size_t end = key.find_last_not_of("0123456789");
  const bool is_numbered = end != std::string_view::npos && end + 1 < key.size() && key[end] == '_' && key[end + 1] != '0';
  return is_numbered ? key.substr(0, end) : key;
}

Quantity quantity_of(const QuantityType& type, std::string_view key) {
  return {std::string(key), type.kind, std::string(type.unit), type.possible, std::string(type.meaning)};
}

/// Returns the units that logs use besides those of base::kUnitWords: percentages and all of UDUNITS-2. A power or product is written as in
/// the name, "s2" or "Nm".
std::optional<std::string_view> unit_text(std::string_view word) {
  const auto* const known = std::ranges::find(base::kUnitWords, word, &base::UnitWord::word);
  if (known != base::kUnitWords.end()) {
    return known->unit.find_first_of("^ ") == std::string_view::npos ? std::nullopt : std::optional(word);
  }
  if (word == "percent" || word == "pct") {
    return "%";
  }
  const bool is_symbol = !word.empty() && std::isalpha(static_cast<unsigned char>(word[0])) != 0;
  return is_symbol && base::parse_quantity(fmt::format("1 {}", word), word).ok() ? std::optional(word) : std::nullopt;
}

bool is_capital(char c) { return c >= 'A' && c <= 'Z'; }

/// Removes the letter of a phase before the unit: "phase_V_A" is a current and "phase_C_V" a voltage, not a product.
std::string without_phase(const std::string& unit) {
  const std::size_t end = unit.find(' ');
  const std::string_view first = std::string_view(unit).substr(0, end);
  const bool is_letter = first == "degC" || (first.size() == 1 && is_capital(first.front()));
  return end != std::string::npos && is_letter && is_capital(unit[end + 1]) ? unit.substr(end + 1) : unit;
}

/// Returns the unit at the end of a name, for example "rad/s" for "…_rad_per_s". nullopt if there is none.
std::optional<std::string> unit_at_end(std::string_view key) {
  if (key.starts_with('_') || key.find("__") != std::string_view::npos) {
    return std::nullopt;
  }
  const std::optional<std::string> product = base::unit_text_of_name(key, unit_text);
  const std::optional<std::string> unit = product ? std::optional(without_phase(*product)) : std::nullopt;
  return unit && base::parse_quantity("1 " + *unit, *unit).ok() ? unit : std::nullopt;
}

}  // namespace

std::string_view to_string(QuantityKind kind) {
  switch (kind) {
    case Kind::time:
      return "time";
    case Kind::temperature:
      return "temperature of the motor";
    case Kind::surroundings:
      return "surroundings";
    case Kind::heat_input:
      return "heat input";
    case Kind::signal:
      return "other signal";
  }
  return "?";
}

std::span<const QuantityType> quantity_types() { return kTypes; }

namespace {

/// Replaces the name of a quantity in `key` by another one and keeps the number.
std::string renamed(std::string_view key, std::string_view QuantityType::*from, std::string_view QuantityType::*to) {
  for (const QuantityType& type : kTypes) {
    const std::string_view name = type.is_numbered ? without_number(key) : key;
    if (!type.alias.empty() && name == type.*from) {
      return fmt::format("{}{}", type.*to, key.substr(name.size()));
    }
  }
  return std::string(key);
}

}  // namespace

std::string canonical_key(std::string_view key) { return renamed(key, &QuantityType::alias, &QuantityType::key); }
std::string earlier_key(std::string_view key) { return renamed(key, &QuantityType::key, &QuantityType::alias); }

std::optional<Quantity> quantity_named(std::string_view name) {
  const std::string key = canonical_key(name);
  const std::string_view stem = without_number(key);
  for (const QuantityType& type : kTypes) {
    if (type.is_numbered ? stem != key && type.key == stem : type.key == key) {
      return quantity_of(type, key);
    }
  }
  const std::optional<std::string> unit = unit_at_end(stem);
  if (!unit) {
    return std::nullopt;
  }
  const base::Range possible = *unit == "degC" ? kTemperature_C : kAny;
  return Quantity{std::string(key), Kind::signal, *unit, possible, ""};
}

std::string nearest_quantity(std::string_view key) {
  std::vector<std::string> names;
  for (const QuantityType& type : kTypes) {
    names.push_back(std::string(type.key) + (type.is_numbered ? "_1" : ""));
  }
  // For example "winding_F": a known quantity in another unit.
  const std::string stem(key.substr(0, key.rfind('_') + 1));
  std::string_view same;
  for (const QuantityType& type : kTypes) {
    if (stem.size() > 1 && !type.is_numbered && type.key.starts_with(stem) && (same.empty() || type.key.size() < same.size())) {
      same = type.key;
    }
  }
  if (!same.empty() && same != key) {
    return fmt::format("; did you mean '{}'? A column in another unit is read with a mapping (--map)", same);
  }
  return base::did_you_mean(key, names);
}

}  // namespace heatsoak::recording
