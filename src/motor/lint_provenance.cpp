// Checks of sources, confirmations, origins and spreads, and of heat that is counted twice.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "motor/datasheet_network.h"
#include "motor/default_spread.h"
#include "motor/lint_checks.h"
#include "motor/write_motor.h"

namespace heatsoak::motor::lint_checks {
namespace {

/// Relative tolerance of agreed values, which have no spread.
constexpr double kSame = 1e-6;

/// Calls visit(name, parameter) for every value of the file, including those of its effects and sensors.
template <class Visit>
void for_each_parameter(const Motor& motor, const Visit& visit) {
  for (const auto& [key, parameter] : motor.parameters) {
    visit(std::string(key), parameter);
  }
  for (const MotorEffect& effect : motor.effects) {
    for (std::size_t i = 0; i < effect.parameters.size(); ++i) {
      // A choice is a word, not a value with a source.
      if (effect.type->parameters[i].choices.empty()) {
        visit(fmt::format("{}.{}", effect.name, effect.type->parameters[i].key), effect.parameters[i]);
      }
    }
  }
  for (const MotorSensor& sensor : motor.sensors) {
    visit(fmt::format("{}.{}", sensor.name, sensor.type->size.key), sensor.size);
  }
}

}  // namespace

void sources(const Motor& motor, Findings& findings) {
  for_each_parameter(motor, [&](const std::string& key, const base::ParameterValue& parameter) {
    // The derivation of an estimate replaces its source.
    const bool is_derived = parameter.origin == base::Origin::estimated && !parameter.derivation.empty();
    if (parameter.source.empty() && !is_derived) {
      findings.error_at(parameter.at, LintClause{LintWords::no_source, {key, parameter.printed}});
    }
  });
}

/// Two independent sources must agree within the tolerance of the value, else one of them is wrong.
void confirmations(const Motor& motor, Findings& findings) {
  for_each_parameter(motor, [&](const std::string& key, const base::ParameterValue& parameter) {
    const Bounds bounds =
        parameter.spread ? Bounds{parameter.spread->low, parameter.spread->high}
                         : Bounds{parameter.value - kSame * std::abs(parameter.value), parameter.value + kSame * std::abs(parameter.value)};
    for (const base::Confirmation& other : parameter.confirmed_by) {
      if (bounds.excludes(other.value)) {
        findings.error_at(parameter.at, LintClause{LintWords::confirmation_differs, {key, parameter.printed, other.source, other.printed}});
      }
    }
  });
}

void estimates(const Motor& motor, Findings& findings) {
  for (const MotorParameterSpec& each : motor_parameter_specs()) {
    const auto parameter = motor.parameters.find(each.spec.key);
    if (parameter == motor.parameters.end() || parameter->second.origin != base::Origin::estimated) {
      continue;
    }
    const LintClause found{LintWords::estimated, {each.spec.key, shown(parameter->second.value, each.spec.unit)}};
    if (each.is_thermal) {
      findings.note(each.spec.key, LintClause{LintWords::thermal_estimate, {found}});
    } else if (each.spec.key.starts_with("nominal_")) {
      findings.note(each.spec.key, LintClause{LintWords::nominal_estimate, {found}});
    }
  }
}

void spreads(const Motor& motor, Findings& findings) {
  for (const auto& [key, parameter] : motor.parameters) {
    if (!is_agreed(key) && !parameter.spread) {
      findings.warning(key, LintClause{LintWords::no_spread, {key, parameter.printed}});
    }
  }
}

/// Real parts have a tolerance, so a spread of zero width is an error.
void exact_values(const Motor& motor, Findings& findings) {
  for_each_parameter(motor, [&](const std::string& key, const base::ParameterValue& parameter) {
    if (is_exact(parameter) && !is_agreed(key)) {
      findings.error_at(parameter.at, LintClause{LintWords::zero_spread, {key, parameter.printed}});
    }
  });
}

/// A spread of 0.001 % is as unlikely as none. A fit may produce one: the spread is widened, and a file of `calibrate` gets no note,
/// because there is nothing that the user could correct.
void narrow_values(const Motor& motor, Findings& findings) {
  for (const NarrowSpread& each : narrow_spreads(motor)) {
    const base::ParameterValue& parameter = *each.parameter;
    const auto percent = [&](double bound) { return 100.0 * std::abs(bound / parameter.value - 1.0); };
    if (each.is_fitted && parameter.source.find(kCalibrationSource) != std::string::npos) {
      continue;
    }
    const LintClause what{
        LintWords::narrow_spread,
        {each.key, parameter.printed, base::to_string(parameter.origin), LintNumber{percent(parameter.spread->low), 2},
         LintNumber{percent(parameter.spread->high), 2}, LintNumber{percent(each.least.low), 2}, LintNumber{percent(each.least.high), 2},
         LintClause{each.is_fitted ? LintWords::spread_is_assumed : LintWords::state_spread}}};
    each.is_fitted ? findings.note_at(parameter.at, what) : findings.error_at(parameter.at, what);
  }
}

void heat_counted_twice(const Motor& motor, Findings& findings) {
  // A data sheet divides the rise of the winding by the whole copper loss. Only a fit separates the share that takes another way.
  constexpr const char* kAcross = "thermal_resistance_winding_stator";
  const auto is_measured = [](const base::ParameterValue& value) { return value.origin == base::Origin::measured; };
  const auto across = motor.parameters.find(kAcross);
  const bool is_across_fitted = (across != motor.parameters.end() && is_measured(across->second)) ||
                                (motor.fit && std::ranges::find(motor.fit->parameters, kAcross) != motor.fit->parameters.end());
  for (const MotorEffect& effect : motor.effects) {
    if (is_loss_of_every_motor(*effect.type)) {
      findings.warning_at(effect.parameters.front().at, LintClause{LintWords::loss_counted_twice, {effect.name, effect.type->name}});
    } else if (effect.type->name == "input_power_loss") {
      findings.warning_at(effect.parameters.front().at, LintClause{LintWords::input_power_counted_twice, {effect.name}});
    } else if (effect.type->moves_copper_loss && !(is_across_fitted && is_measured(effect.parameters.front()))) {
      findings.warning_at(effect.parameters.front().at, LintClause{LintWords::share_counted_twice, {effect.name}});
    }
  }
}

}  // namespace heatsoak::motor::lint_checks
