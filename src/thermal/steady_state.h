// Steady state of a network at a constant operating point.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "thermal/network.h"

namespace heatsoak::thermal {

struct SteadyState {
  std::vector<double> temperature_C;  ///< one per state node
};

/// Solves rate = 0 by Newton's method, in one step if the network is linear in temperature. Returns nothing if there is no stable steady
/// state (thermal runaway: the copper loss grows faster than the cooling). Throws Failure (numerics_failed) if the iteration does not
/// converge.
std::optional<SteadyState> steady_state(const Network& network, const OperatingPoint<double>& at);

/// Writes dT/dt in K/s of all nodes at the temperatures `state_C`.
using RateFunction = std::function<void(std::span<const double> state_C, std::span<double> rate_K_per_s)>;
/// Solves rate = 0 for any thermal system; Newton's method starts at `start_C`.
std::optional<SteadyState> steady_state(const RateFunction& rates, std::span<const double> start_C);

/// Current that is switched on and off periodically.
struct OnOffCurrent {
  double current_on_A = 0.0;
  double time_on_s = 0.0;
  double time_off_s = 0.0;
  double ambient_C = 25.0;
};
/// Values of a motor with the nodes winding and stator.
struct TwoNodeMotor {
  double terminal_resistance_25C_ohm = 0.0;
  double temperature_coefficient_per_K = 0.0;
  double thermal_resistance_winding_stator_K_per_W = 0.0;
  double thermal_resistance_stator_ambient_K_per_W = 0.0;
};
struct OnOffSteadyState {
  double current_rms_A = 0.0;
  bool runaway = false;  ///< the denominator of equation (9) is not positive; the temperatures are then invalid
  double winding_C = 0.0;
  double stator_C = 0.0;
};
/// Returns the steady state under an on/off current after maxon: equations (8) to (12) of the RoboTeam Twente paper of 2025. α refers to
/// 25 °C. For another ambient temperature T_A it is converted together with R, which keeps the equations exact for the network:
/// R_TA = R25·(1+α(T_A−25)), α_TA = α·R25/R_TA.
OnOffSteadyState on_off_steady_state(const TwoNodeMotor& motor, const OnOffCurrent& current);

}  // namespace heatsoak::thermal
