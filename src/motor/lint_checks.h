// Interface shared by the lint checks. A check reports nothing unless the file gives all the values that it compares.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/unknown.h"
#include "motor/lint.h"

namespace heatsoak::motor::lint_checks {

/// Collects the findings of one check.
class Findings {
 public:
  Findings(const Motor& motor, std::string_view check, std::vector<LintFinding>& list) : motor_(motor), check_(check), list_(list) {}

  void error(std::string_view key, LintClause what) { add(LintFinding::Level::error, key, std::move(what)); }
  void warning(std::string_view key, LintClause what) { add(LintFinding::Level::warning, key, std::move(what)); }
  void note(std::string_view key, LintClause what) { add(LintFinding::Level::note, key, std::move(what)); }
  void error_at(base::Location at, LintClause what) { add_at(LintFinding::Level::error, std::move(at), std::move(what)); }
  void note_at(base::Location at, LintClause what) { add_at(LintFinding::Level::note, std::move(at), std::move(what)); }
  void warning_at(base::Location at, LintClause what) { add_at(LintFinding::Level::warning, std::move(at), std::move(what)); }
  /// Adds a finding about the value `key`, with its place in the file.
  void add(LintFinding::Level level, std::string_view key, LintClause what);

 private:
  void add_at(LintFinding::Level level, base::Location at, LintClause what) {
    list_.push_back({level, std::string(check_), std::move(what), std::move(at)});
  }

  const Motor& motor_;
  std::string_view check_;
  std::vector<LintFinding>& list_;
};

/// Ambient temperature at which the nominal values of data sheets hold.
inline constexpr double kSheetAmbient_C = 25.0;

struct Bounds {
  double low = 0.0;
  double high = 0.0;
  /// Returns whether the value is out of bounds; false for NaN, so that absent values cause no finding.
  [[nodiscard]] bool excludes(double value) const { return value < low || value > high; }
};

/// Returns the value, or NaN if it is absent: every comparison with it is false, so that the check finds nothing. lint() gives the checks a
/// motor whose missing required values are NaN for the same reason.
inline double plain(const std::optional<double>& value) { return value.value_or(base::kUnknown); }

/// Returns error, or warning if one of the contradicting values is an estimate.
LintFinding::Level level_of_contradiction(const Motor& motor, std::initializer_list<std::string_view> keys);
/// Returns whether all values that a thermal network needs are present; a file that was read incompletely may lack some.
bool is_complete(const Motor& motor);
/// Returns the terminal resistance at `temperature_C`, in ohm.
double resistance_ohm(const MotorValues& values, double temperature_C);

/// These functions return a value in the unit in which a data sheet prints it.
LintQuantity shown_torque(double torque_Nm);
LintQuantity shown_speed(double speed_rad_per_s);
LintQuantity shown_torque_constant(double constant_Nm_per_A);
LintQuantity shown_speed_constant(double constant_rad_per_s_per_V);
LintQuantity shown_gradient(double gradient_rad_per_s_per_Nm);
LintQuantity shown_inertia(double inertia_kg_m2);
LintQuantity shown(double value, std::string_view unit);

// Electrical and mechanical values: lint_electrical.cpp
void constants(const Motor& motor, Findings& findings);
void mechanical_time_constant(const Motor& motor, Findings& findings);
void speed_torque_gradient(const Motor& motor, Findings& findings);
void stall_current(const Motor& motor, Findings& findings);
void stall_torque(const Motor& motor, Findings& findings);
void no_load_speed(const Motor& motor, Findings& findings);
void max_efficiency(const Motor& motor, Findings& findings);

// Nominal and peak operating point: lint_nominal_point.cpp
void nominal_current(const Motor& motor, Findings& findings);
void peak_point(const Motor& motor, Findings& findings);
void power_balance(const Motor& motor, Findings& findings);
void assigned_power(const Motor& motor, Findings& findings);
void nominal_speed(const Motor& motor, Findings& findings);
void nominal_point_heat_check(const Motor& motor, Findings& findings);
void copper_limit(const Motor& motor, Findings& findings);

// Orders of magnitude: lint_magnitude.cpp
void required_values(const Motor& motor, Findings& findings);
void heat_capacities(const Motor& motor, Findings& findings);
void electrical_time_constant(const Motor& motor, Findings& findings);
void density(const Motor& motor, Findings& findings);
void rotor_inertia(const Motor& motor, Findings& findings);
void limits(const Motor& motor, Findings& findings);
void effect_sizes(const Motor& motor, Findings& findings);

// Sources, spreads and origins of the values: lint_provenance.cpp
void sources(const Motor& motor, Findings& findings);
void confirmations(const Motor& motor, Findings& findings);
void estimates(const Motor& motor, Findings& findings);
void spreads(const Motor& motor, Findings& findings);
void exact_values(const Motor& motor, Findings& findings);
void narrow_values(const Motor& motor, Findings& findings);
void heat_counted_twice(const Motor& motor, Findings& findings);

}  // namespace heatsoak::motor::lint_checks
