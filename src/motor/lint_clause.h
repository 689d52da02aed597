// Findings of the lint checks as data: what is wrong, with numbers and names. lint_words.cpp has the sentences.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace heatsoak::motor {

/// Sentences and parts of sentences.
enum class LintWords {
  contradictory_conventions,
  speed_constant_is_wrong,
  speed_constant_is_right,
  constants_product,
  mechanical_time_constant,
  speed_torque_gradient,
  stall_current,
  stall_torque,
  no_load_speed,
  max_efficiency,
  heat_capacity,
  lasting_current,
  ideal_speed,
  no_load_heating,
  thermal_resistance_ratio,
  heat_capacity_ratio,
  winding_heat_capacity,
  stator_heat_capacity,
  heat_capacities_swapped,
  electrical_time_constant,
  density,
  inertia_too_large,
  external_inertia_too_small,
  temperatures_out_of_order,
  stator_limit_above_winding,
  nominal_speed_above_highest,
  no_load_speed_above_highest,
  no_load_current_above_nominal,
  nominal_torque_of_current,
  peak_torque_below_nominal,
  peak_current_below_nominal,
  peak_torque_of_current,
  nominal_power,
  nominal_power_above_input,
  nominal_losses_too_large,
  nominal_losses_too_small,
  assigned_power_too_large,
  assigned_power_of_type,
  nominal_speed_too_high,
  nominal_speed_too_low,
  resistance_needed,
  resistance_of_one_phase,
  heat_without_current,
  nominal_heat,
  copper_heat,
  no_source,
  confirmation_differs,
  estimated,
  no_spread,
  zero_spread,
  narrow_spread,
  loss_counted_twice,
  input_power_counted_twice,
  share_counted_twice,
  effect_size,
  own_conductance,
  room_of_stator,
  own_resistance,
  own_heat_capacity,
  contact_radius_large,
  wheels_too_large,
  nominal_above_full,
  nominal_below_empty,
  empty_above_full,
  voltage_above_small_robots,
  mass_large,
  voltage_limit_above_full,
  gear_ratio_small,
  gear_ratio_large,
  yaw_inertia,
  wheel_inertia,
  center_of_gravity_high,
  wheel_torque_large,
  speed_large,
  jerk_small,
  acceleration_large,
  missing_value,
  unknown_motor,
  no_motor_file,
  emf_peak_of_phase,
  emf_rms_of_phase,
  emf_rms_between_terminals,
  emf_peak_between_terminals,
  per_phase_peak,
  per_phase_rms,
  declared_per_phase_peak,
  declared_per_phase_rms,
  terminals_over_phase,
  phase_over_terminals,
  sinusoidal_current,
  sinusoidal_current_inverse,
  peak_over_rms,
  rms_over_peak,
  one_phase_of_two,
  two_phases_of_one,
  no_convention,
  resistance_is_of_one_phase,
  resistance_is_between_terminals,
  check_resistance,
  stall_torque_without_saturation,
  stall_torque_differs,
  stall_torque_looks_saturated,
  stall_torque_too_large,
  speed,
  torque,
  density_impossible,
  density_unusual,
  check_external_rotor,
  check_flat_rotor,
  sheet_ambient,
  winding_limit,
  ambient_max,
  ambient_min,
  highest,
  possible_heat,
  usual_heat,
  thermal_estimate,
  nominal_estimate,
  spread_is_assumed,
  state_spread,
  length,
  overlap,
  are_large,
  same_angle,
  angle_above_turn,
  friction_missing,
  match_needs_it,
  closed_loop_needs_it,
  rotor_inertia_missing
};

/// A quantity that is printed with three significant digits, a speed in rpm at least in whole rpm.
struct LintQuantity {
  double value = 0.0;
  std::string_view unit;
};

/// A pure number that is printed with this number of significant digits.
struct LintNumber {
  double value = 0.0;
  int digits = 3;
};

struct LintFact;

/// A sentence, or a part of one, with the facts that it states.
struct LintClause {
  LintWords words;
  std::vector<LintFact> facts = {};
};

/// A plain number has the format that the sentence gives it. A text is a name or a value as the file writes it.
struct LintFact {
  std::variant<double, LintQuantity, LintNumber, std::string, LintClause> is;

  LintFact(double value) : is(value) {}
  LintFact(LintQuantity quantity) : is(quantity) {}
  LintFact(LintNumber number) : is(number) {}
  LintFact(std::string name) : is(std::move(name)) {}
  LintFact(std::string_view name) : is(std::string(name)) {}
  LintFact(LintClause part) : is(std::move(part)) {}
};

/// Returns the sentence.
std::string text_of(const LintClause& clause);

}  // namespace heatsoak::motor
