#include "motor/default_spread.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "motor/lint.h"
#include "motor/read_motor.h"

namespace heatsoak::motor {
namespace {

/// Bounds as ratios to the value.
struct Ratios {
  double low = 1.0;
  double high = 1.0;
};

/// Default bounds of one key by origin. A measured value without an uncertainty gets the bounds of an estimate.
struct DefaultRow {
  std::string_view key;
  Ratios sheet;
  Ratios third_party;
  Ratios derived;
  Ratios estimated;
};

// Manufacturers publish nominal values without tolerances. The column of the data sheet holds the engineering defaults of
// motor_db/README.md. The others enclose the widest range that motor_db derives for that origin from similar motors.
constexpr std::array kDefaults{
    // Production tolerance of the wire's cross-section and length, and contacts.
    DefaultRow{"terminal_resistance", {0.90, 1.10}, {0.90, 1.10}, {0.85, 1.25}, {0.80, 1.30}},
    // Remanence of the magnets and width of the air gap.
    DefaultRow{"torque_constant", {0.93, 1.07}, {0.93, 1.07}, {0.90, 1.10}, {0.85, 1.15}},
    // Bearing friction and iron loss vary most between parts, more upwards than downwards.
    DefaultRow{"no_load_current", {0.65, 1.55}, {0.65, 1.55}, {0.65, 2.05}, {0.55, 2.05}},
    // Impregnation of the winding.
    DefaultRow{"thermal_resistance_winding_stator", {0.75, 1.25}, {0.75, 1.25}, {0.70, 1.35}, {0.55, 1.80}},
    // Mounting, orientation and air movement.
    DefaultRow{"thermal_resistance_stator_ambient", {0.75, 1.25}, {0.75, 1.25}, {0.70, 1.35}, {0.50, 1.80}},
    // A thermal resistance from above times a heat capacity.
    DefaultRow{"thermal_time_constant_winding", {0.75, 1.25}, {0.60, 1.60}, {0.60, 1.60}, {0.45, 2.05}},
    DefaultRow{"thermal_time_constant_stator", {0.75, 1.25}, {0.60, 1.60}, {0.60, 1.60}, {0.45, 2.05}},
    // A property of copper; other alloys have a data sheet of their own.
    DefaultRow{"temperature_coefficient", {0.98, 1.02}, {0.98, 1.02}, {0.95, 1.05}, {0.90, 1.10}},
};

/// Effects have parameters of many kinds, so the default depends on the origin only: an estimate may be wrong by a factor of 1.5.
constexpr DefaultRow kEffectDefault{"", {0.75, 1.25}, {0.75, 1.25}, {0.70, 1.35}, {1.0 / 1.5, 1.5}};

const Ratios& ratios(const DefaultRow& row, base::Origin origin) {
  switch (origin) {
    case base::Origin::datasheet:
      return row.sheet;
    case base::Origin::third_party:
      return row.third_party;
    case base::Origin::derived:
      return row.derived;
    case base::Origin::measured:
    case base::Origin::estimated:
      break;
  }
  return row.estimated;
}

const DefaultRow* row_of(std::string_view key) {
  const auto* const found = std::ranges::find(kDefaults, key, &DefaultRow::key);
  return found == kDefaults.end() ? nullptr : found;
}

/// Returns the spread around the value, clipped to the declared range so that no sample leaves it.
base::Spread spread_by(const Ratios& by, const base::ParameterValue& parameter, const base::Range& range) {
  const double one = parameter.value * by.low;
  const double other = parameter.value * by.high;
  return {base::Spread::Kind::range, std::max(std::min(one, other), range.low), std::min(std::max(one, other), range.high),
          parameter.value > 0.0};
}

/// Returns the narrowest credible bounds. Well documented files of motor_db state at least 27 % of the default spread. A fit can be more
/// accurate, but no thermal measurement is more accurate than its sensors. A measured value that no fit supports is a claim: a
/// thermocouple of 1 K gives 2 % of a rise of 50 K, and a winding differs from the next by about 2 % in resistance and torque constant.
Ratios least_ratios(const DefaultRow& row, base::Origin origin, bool is_fitted) {
  constexpr double kLeastShare = 0.25;
  constexpr double kLeastFitted = 0.01;
  constexpr double kLeastMeasured = 0.02;
  const Ratios& by = ratios(row, origin == base::Origin::measured ? base::Origin::datasheet : origin);
  const double low = kLeastShare * (1.0 - by.low);
  const double high = kLeastShare * (by.high - 1.0);
  const double least = is_fitted ? kLeastFitted : kLeastMeasured;
  return origin == base::Origin::measured ? Ratios{1.0 - std::min(low, least), 1.0 + std::min(high, least)} : Ratios{1.0 - low, 1.0 + high};
}

/// Returns whether the file records the fit that a value comes from. A value that the fit does not determine alone keeps its origin.
bool is_fitted(const Motor& motor, std::string_view key) {
  return motor.fit && std::ranges::find(motor.fit->parameters, key) != motor.fit->parameters.end();
}

/// Returns whether the stated spread is too narrow. A bound at the end of the declared range is always wide enough.
bool is_narrow(const base::ParameterValue& parameter, const base::Spread& least, const base::Range& range) {
  constexpr double kRounding = 1e-3;  // rounding of a printed tolerance
  const double slack = kRounding * std::abs(parameter.value);
  return parameter.spread && ((parameter.spread->low > least.low + slack && parameter.spread->low > range.low) ||
                              (parameter.spread->high < least.high - slack && parameter.spread->high < range.high));
}

/// Returns the spread that replaces the stated one; nothing if the stated one is credible.
std::optional<base::Spread> replacement(const DefaultRow& row, const base::ParameterValue& parameter, const base::Range& range,
                                        bool is_fitted) {
  if (parameter.value == 0.0) {
    return std::nullopt;
  }
  const base::Spread usual = spread_by(ratios(row, parameter.origin), parameter, range);
  if (!parameter.spread || is_exact(parameter)) {
    return usual;
  }
  const base::Spread least = spread_by(least_ratios(row, parameter.origin, is_fitted), parameter, range);
  if (!is_narrow(parameter, least, range)) {
    return std::nullopt;
  }
  if (!is_fitted) {
    return usual;
  }
  return base::Spread{base::Spread::Kind::range, std::min(parameter.spread->low, least.low), std::max(parameter.spread->high, least.high),
                      parameter.value > 0.0};
}

/// False for the knots of a curve and for temperatures: these are chosen, so no relative uncertainty applies.
bool takes_default(const thermal::EffectType& type, std::size_t place) {
  const base::ParameterSpec& spec = type.parameters[place];
  return spec.choices.empty() && spec.unit != "degC" && !spec.key.ends_with("_knot");
}

/// Calls `visit(key, parameter, row, range)` for every value that temperatures depend on.
template <class AnyMotor, class Visit>
void for_each_value(AnyMotor& motor, const Visit& visit) {
  for (const MotorParameterSpec& each : motor_parameter_specs()) {
    const DefaultRow* const row = row_of(each.spec.key);
    const auto found = motor.parameters.find(each.spec.key);
    if (row && found != motor.parameters.end()) {
      visit(std::string(each.spec.key), found->second, *row, each.spec.range);
    }
  }
  for (auto& effect : motor.effects) {
    for (std::size_t i = 0; i < effect.parameters.size(); ++i) {
      if (takes_default(*effect.type, i)) {
        const base::ParameterSpec& spec = effect.type->parameters[i];
        visit(fmt::format("effects.{}.{}", effect.name, spec.key), effect.parameters[i], kEffectDefault, spec.range);
      }
    }
  }
}

}  // namespace

bool is_exact(const base::ParameterValue& parameter) {
  return parameter.spread && parameter.value != 0.0 && !(parameter.spread->high > parameter.spread->low);
}

bool needs_spread(std::string_view key) { return row_of(key) != nullptr; }

std::vector<DefaultSpread> default_spreads(const Motor& motor) {
  std::vector<DefaultSpread> missing;
  for_each_value(motor,
                 [&](const std::string& key, const base::ParameterValue& parameter, const DefaultRow& row, const base::Range& range) {
                   if (const std::optional<base::Spread> spread = replacement(row, parameter, range, is_fitted(motor, key))) {
                     missing.push_back({key, parameter.origin, parameter.value, *spread});
                   }
                 });
  return missing;
}

std::vector<NarrowSpread> narrow_spreads(const Motor& motor) {
  std::vector<NarrowSpread> narrow;
  for_each_value(motor,
                 [&](const std::string& key, const base::ParameterValue& parameter, const DefaultRow& row, const base::Range& range) {
                   const bool fitted = is_fitted(motor, key);
                   const base::Spread least = spread_by(least_ratios(row, parameter.origin, fitted), parameter, range);
                   if (parameter.value != 0.0 && !is_exact(parameter) && is_narrow(parameter, least, range)) {
                     narrow.push_back({key, &parameter, least, fitted});
                   }
                 });
  return narrow;
}

Motor with_default_spreads(Motor motor) {
  for_each_value(motor, [&motor](const std::string& key, base::ParameterValue& parameter, const DefaultRow& row, const base::Range& range) {
    if (const std::optional<base::Spread> spread = replacement(row, parameter, range, is_fitted(motor, key))) {
      parameter.spread = spread;
    }
  });
  return motor;
}

std::optional<base::Spread> spread_or_default(const Motor& motor, std::string_view key) {
  const auto found = motor.parameters.find(key);
  const auto spec = std::ranges::find(motor_parameter_specs(), key, [](const MotorParameterSpec& each) { return each.spec.key; });
  if (found == motor.parameters.end() || spec == motor_parameter_specs().end()) {
    return std::nullopt;
  }
  const DefaultRow* const row = row_of(key);
  const std::optional<base::Spread> other = row ? replacement(*row, found->second, spec->spec.range, is_fitted(motor, key)) : std::nullopt;
  return other ? other : found->second.spread;
}

std::string to_string(std::span<const DefaultSpread> spreads) {
  std::string text;
  for (const DefaultSpread& each : spreads) {
    const auto percent = [&](double bound) { return 100.0 * (bound / each.value - 1.0); };
    const auto [low, high] = std::minmax({percent(each.spread.low), percent(each.spread.high)});
    text += fmt::format("{}{} {:+.0f} to {:+.0f} % ({})", text.empty() ? "" : ", ", each.key, low, high, base::to_string(each.origin));
  }
  return text;
}

void require_sound(const Motor& motor) {
  base::Diagnostics diagnostics;
  add_lint_errors(motor, diagnostics);
  diagnostics.throw_if_any();
}

Motor read_sound_motor(const std::filesystem::path& path) {
  base::Diagnostics diagnostics;
  Motor motor = read_motor(path, diagnostics);
  add_lint_errors(motor, diagnostics);
  diagnostics.throw_if_any();
  return motor;
}

}  // namespace heatsoak::motor
