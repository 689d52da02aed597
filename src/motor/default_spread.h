// Default spreads for values whose file states none, or a narrower one than is credible, so that a missing tolerance never means an exact
// value.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "motor/motor.h"

namespace heatsoak::motor {

/// A value of a motor whose spread is replaced, and the spread that is assumed for it.
struct DefaultSpread {
  std::string key;  ///< "thermal_resistance_stator_ambient", "effects.chassis.conductance"
  base::Origin origin = base::Origin::estimated;
  double value = 0.0;   ///< in the unit of the declaration
  base::Spread spread;  ///< range around the value, in the same unit
};

/// Returns true if the stated spread has zero width, such as a tolerance of 0 %. False for a value of 0, whose relative spread is always
/// zero.
bool is_exact(const base::ParameterValue& parameter);

/// Returns true if temperatures depend on the value of this key, so that its spread affects the probability of exceeding a limit.
bool needs_spread(std::string_view key);

/// Returns the temperature-relevant values whose file states no spread, a spread of zero width, or one of narrow_spreads(); in the order of
/// sampling. A measured value with a too narrow spread gets the narrowest credible one, every other value the default. The default depends
/// on key and origin, for parameters of effects on the origin only. It is at least as wide as every range in motor_db of that key and
/// origin.
std::vector<DefaultSpread> default_spreads(const Motor& motor);

/// A stated spread that is narrower than is credible for the origin of its value: on one side less than a quarter of the default of that
/// key and origin. For a measured value two conditions must hold: less than a quarter of the default of a data sheet value, and less than 2
/// %. The 2 % become 1 % if the file records the fit that gave the value.
struct NarrowSpread {
  std::string key;
  const base::ParameterValue* parameter = nullptr;
  base::Spread least;      ///< narrowest credible range, in the unit of the declaration
  bool is_fitted = false;  ///< measured by a fit of the file
};
/// Returns all stated spreads of the motor that are too narrow.
std::vector<NarrowSpread> narrow_spreads(const Motor& motor);

/// Returns the motor with all default spreads applied. Every function that samples motors for a verdict or for firmware calls it first.
Motor with_default_spreads(Motor motor);

/// Returns the spread of a value, the stated or the assumed one. Nothing if the motor lacks the value or it has no spread.
std::optional<base::Spread> spread_or_default(const Motor& motor, std::string_view key);

/// Formats as "thermal_resistance_stator_ambient -25 to +25 % (datasheet), …"; empty for an empty list.
std::string to_string(std::span<const DefaultSpread> spreads);

/// Throws Failure (bad_input) with every error that lint() finds, as file:line:column and what to do. Missing spreads are accepted, because
/// defaults replace them; spreads of zero width are not. Every command that gives a verdict or firmware calls it first.
void require_sound(const Motor& motor);

/// Reads a motor file and checks it like require_sound(). Throws Failure (bad_input) with all problems of reading and of lint.
Motor read_sound_motor(const std::filesystem::path& path);

}  // namespace heatsoak::motor
