// Spreads that stand in for those that a motor's file does not give, or states narrower than anybody can know them, so that a missing
// tolerance never means an exact value.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "motor/motor.h"

namespace heatsoak {

/// A value of a motor without a spread of its own, and the spread that this program assumes for it.
struct DefaultSpread {
  std::string key;  ///< "thermal_resistance_stator_ambient", "effects.chassis.conductance"
  Origin origin = Origin::estimated;
  double value = 0.0;  ///< in the unit of the declaration
  Spread spread;       ///< a range that encloses the value, in the same unit
};

/// True if the file states a spread that leaves the value no freedom, such as a tolerance of 0 %. A value of 0 has none by nature.
bool is_exact(const Figure& figure);

/// True if temperatures depend on the value of this key: its spread decides how many drawn motors exceed a limit.
bool needs_spread(std::string_view key);

/// The values that temperatures depend on and for which the file states no spread, a zero one or one of narrow_spreads(), in the order of
/// the draws. A measured value with too narrow a spread gets the narrowest that is believed, every other one the default. The assumed range
/// follows from key and origin by one table, and from the origin alone for parameters of effects. It is at least as wide as every range in
/// motor_db of that key and origin.
std::vector<DefaultSpread> default_spreads(const Motor& motor);

/// A stated spread that is narrower than the origin of its value can support: on either side less than a quarter of the default of that key
/// and origin, or of a measured value less than 1 % (and than that quarter of a data sheet's).
struct NarrowSpread {
  std::string key;
  const Figure* figure = nullptr;
  Spread least;  ///< the narrowest range that is believed, in the unit of the declaration
};
std::vector<NarrowSpread> narrow_spreads(const Motor& motor);

/// The motor with these spreads in place. Every function that draws motors for a verdict or for firmware begins with it.
Motor with_default_spreads(Motor motor);

/// The spread of a value, its own or the assumed one; nothing if the motor lacks the value or no temperature depends on it.
std::optional<Spread> spread_or_default(const Motor& motor, std::string_view key);

/// "thermal_resistance_stator_ambient -25 to +25 % (datasheet), …". Empty for an empty list.
std::string to_string(std::span<const DefaultSpread> spreads);

/// Throws Failure (bad_input) with every error that lint() finds, as file:line:column and what to do. A missing spread is no such error,
/// because a default takes its place; a spread of zero is one. Every verb that gives a verdict or firmware asks this first.
void require_sound(const Motor& motor);

/// Reads the file and asks the same of it. Throws Failure (bad_input) with every problem of both kinds.
Motor read_sound_motor(const std::filesystem::path& path);

}  // namespace heatsoak
