#include "motor/lint.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "base/copper.h"
#include "base/quantity.h"
#include "base/unknown.h"
#include "motor/lint_checks.h"

namespace heatsoak::motor {
namespace lint_checks {

void Findings::add(LintFinding::Level level, std::string_view key, LintClause what) {
  const auto parameter = motor_.parameters.find(key);
  base::Location at = parameter != motor_.parameters.end() ? parameter->second.at : base::Location{motor_.file.string()};
  add_at(level, std::move(at), std::move(what));
}

LintFinding::Level level_of_contradiction(const Motor& motor, std::initializer_list<std::string_view> keys) {
  const bool is_estimated = std::ranges::any_of(keys, [&](std::string_view key) {
    const auto parameter = motor.parameters.find(key);
    return parameter != motor.parameters.end() && parameter->second.origin == base::Origin::estimated;
  });
  return is_estimated ? LintFinding::Level::warning : LintFinding::Level::error;
}

bool is_complete(const Motor& motor) {
  return std::ranges::all_of(motor_parameter_specs(), [&](const MotorParameterSpec& each) {
    return each.need == input::Need::optional || motor.parameters.contains(each.spec.key);
  });
}

double resistance_ohm(const MotorValues& values, double temperature_C) {
  return values.terminal_resistance_ohm * base::resistance_ratio(values.temperature_coefficient_per_K, temperature_C);
}

LintQuantity shown(double value, std::string_view unit) { return {value, unit}; }
LintQuantity shown_torque(double torque_Nm) { return shown(torque_Nm * 1e3, "mN m"); }
LintQuantity shown_speed(double speed_rad_per_s) { return shown(base::convert(speed_rad_per_s, "rad/s", "rpm"), "rpm"); }
LintQuantity shown_torque_constant(double constant_Nm_per_A) { return shown(constant_Nm_per_A * 1e3, "mN m/A"); }
LintQuantity shown_speed_constant(double constant_rad_per_s_per_V) {
  return shown(base::convert(constant_rad_per_s_per_V, "rad/s/V", "rpm/V"), "rpm/V");
}
LintQuantity shown_gradient(double gradient_rad_per_s_per_Nm) {
  return shown(base::convert(gradient_rad_per_s_per_Nm, "rad/s/(N m)", "rpm/(mN m)"), "rpm/(mN m)");
}
LintQuantity shown_inertia(double inertia_kg_m2) { return shown(inertia_kg_m2 * 1e7, "g cm2"); }

}  // namespace lint_checks

namespace {

struct NamedCheck {
  std::string_view name;
  void (*run)(const Motor&, lint_checks::Findings&);
  bool is_of_values = true;  ///< checks values of the data sheet, from which a fit may differ
};

constexpr std::array kChecks = {
    NamedCheck{"constants", lint_checks::constants},
    NamedCheck{"mechanical_time_constant", lint_checks::mechanical_time_constant},
    NamedCheck{"speed_torque_gradient", lint_checks::speed_torque_gradient},
    NamedCheck{"stall_current", lint_checks::stall_current},
    NamedCheck{"stall_torque", lint_checks::stall_torque},
    NamedCheck{"no_load_speed", lint_checks::no_load_speed},
    NamedCheck{"max_efficiency", lint_checks::max_efficiency},
    NamedCheck{"nominal_current", lint_checks::nominal_current},
    NamedCheck{"peak_point", lint_checks::peak_point},
    NamedCheck{"power_balance", lint_checks::power_balance},
    NamedCheck{"assigned_power", lint_checks::assigned_power},
    NamedCheck{"nominal_speed", lint_checks::nominal_speed},
    NamedCheck{"nominal_point_heat", lint_checks::nominal_point_heat_check},
    NamedCheck{"copper_limit", lint_checks::copper_limit},
    NamedCheck{"required_values", lint_checks::required_values},
    NamedCheck{"heat_capacities", lint_checks::heat_capacities},
    NamedCheck{"electrical_time_constant", lint_checks::electrical_time_constant},
    NamedCheck{"density", lint_checks::density},
    NamedCheck{"rotor_inertia", lint_checks::rotor_inertia},
    NamedCheck{"limits", lint_checks::limits},
    NamedCheck{"effect_sizes", lint_checks::effect_sizes, false},
    NamedCheck{"sources", lint_checks::sources, false},
    NamedCheck{"confirmations", lint_checks::confirmations, false},
    NamedCheck{kEstimatesCheck, lint_checks::estimates, false},
    NamedCheck{"spreads", lint_checks::spreads, false},
    NamedCheck{"exact_values", lint_checks::exact_values, false},
    NamedCheck{"narrow_values", lint_checks::narrow_values, false},
    NamedCheck{"heat_counted_twice", lint_checks::heat_counted_twice, false},
};

/// Returns the motor with NaN for each required value that its file lacks.
Motor with_unknown_values(const Motor& file) {
  Motor motor = file;
  for (const MotorParameterSpec& each : motor_parameter_specs()) {
    if (each.need == input::Need::required && !motor.parameters.contains(each.spec.key)) {
      std::visit([&](const auto member) { motor.nominal.*member = base::kUnknown; }, each.value);
    }
  }
  return motor;
}

}  // namespace

std::string_view to_string(LintFinding::Level level) {
  switch (level) {
    case LintFinding::Level::error:
      return "error";
    case LintFinding::Level::warning:
      return "warning";
    case LintFinding::Level::note:
      break;
  }
  return "note";
}

std::string message_of(const LintFinding& finding) { return text_of(finding.what); }

std::string words_of(const LintFinding& finding) {
  return fmt::format("{}: {}", finding.key.empty() ? finding.check : finding.key, message_of(finding));
}

std::vector<LintFinding> lint(const Motor& file) {
  const Motor motor = with_unknown_values(file);
  std::vector<LintFinding> list;
  for (const NamedCheck& check : kChecks) {
    lint_checks::Findings findings(motor, check.name, list);
    const std::size_t before = list.size();
    check.run(motor, findings);
    // Fitted values describe one motor, the other values the data sheet: a difference between them is no fault of the file.
    for (std::size_t i = before; i < list.size() && motor.fit && check.is_of_values; ++i) {
      list[i].level = LintFinding::Level::note;
    }
  }
  return list;
}

std::vector<LintFinding> doubtful_values(const Motor& motor) {
  std::vector<LintFinding> findings = lint(motor);
  std::erase_if(findings, [](const LintFinding& each) {
    return each.level != LintFinding::Level::warning || each.what.words == LintWords::no_spread;
  });
  return findings;
}

void add_lint_errors(const Motor& motor, base::Diagnostics& diagnostics) {
  Motor checked = motor;
  if (!diagnostics.empty()) {
    checked.effects.clear();
    checked.sensors.clear();
  }
  std::set<std::optional<int>> lines;
  for (const base::Diagnostic& each : diagnostics.list()) {
    lines.insert(each.at.line);
  }
  for (const LintFinding& each : lint(checked)) {
    // A line that could not be read has a problem already; a value missing because of it is not reported again.
    if (each.level == LintFinding::Level::error && !lines.contains(each.at.line)) {
      diagnostics.add(each.at, each.check, message_of(each));
    }
  }
}

}  // namespace heatsoak::motor
