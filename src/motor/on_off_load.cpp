#include "motor/on_off_load.h"

#include <vector>

#include "motor/datasheet_network.h"

namespace heatsoak::motor {
namespace {

std::vector<thermal::Interval> cycle_of(const thermal::OnOffCurrent& current) {
  thermal::OperatingPoint<double> on;
  on.current_rms_A = current.current_on_A;
  on.ambient_C = current.ambient_C;
  thermal::OperatingPoint<double> off;
  off.ambient_C = current.ambient_C;
  return {{current.time_on_s, on}, {current.time_off_s, off}};
}

/// Returns the result of the closed-form equations. If the motor's file adds effects, returns the steady state of the network under the RMS
/// current instead.
thermal::OnOffSteadyState rest_under_rms(const MotorValues& values, const thermal::Network& network, bool is_bare,
                                         const thermal::OnOffCurrent& current) {
  thermal::OnOffSteadyState state =
      thermal::on_off_steady_state({.terminal_resistance_25C_ohm = values.terminal_resistance_ohm,
                                    .temperature_coefficient_per_K = values.temperature_coefficient_per_K,
                                    .thermal_resistance_winding_stator_K_per_W = values.thermal_resistance_winding_stator_K_per_W,
                                    .thermal_resistance_stator_ambient_K_per_W = values.thermal_resistance_stator_ambient_K_per_W},
                                   current);
  if (!is_bare) {
    thermal::OnOffCurrent constant = current;
    constant.current_on_A = state.current_rms_A;
    constant.time_off_s = 0.0;
    const thermal::PeriodicState rest = thermal::periodic_state(network, cycle_of(constant));
    state.runaway = rest.runaway;
    if (!rest.runaway) {
      state.winding_C = rest.mean_C[states::winding];
      state.stator_C = rest.mean_C[states::stator];
    }
  }
  return state;
}

}  // namespace

OnOffAnswer under_on_off_current(const Motor& motor, const thermal::OnOffCurrent& current) {
  const thermal::Network network = datasheet_network(motor, nominal_sample(motor));
  OnOffAnswer answer{.motor = motor, .current = current, .periodic = {}, .under_rms = {}};
  answer.is_of_the_equations = network.effects().size() == kDatasheetEffects.size();
  answer.under_rms = rest_under_rms(motor.nominal, network, answer.is_of_the_equations, current);
  answer.periodic = thermal::periodic_state(network, cycle_of(current));
  answer.periodic.runaway = answer.periodic.runaway || (answer.is_of_the_equations && answer.under_rms.runaway);
  answer.is_over_limit = answer.is_runaway() || !(answer.periodic.peak_C[states::winding] <= motor.nominal.winding_limit_C);
  return answer;
}

}  // namespace heatsoak::motor
