// One motor under an on/off current: its temperatures in the steady state.
#pragma once

#include "motor/motor.h"
#include "thermal/periodic_state.h"
#include "thermal/steady_state.h"

namespace heatsoak::motor {

struct OnOffAnswer {
  Motor motor;
  thermal::OnOffCurrent current;
  thermal::PeriodicState periodic;      ///< periodic state of the whole network
  thermal::OnOffSteadyState under_rms;  ///< equations (8) to (12), or the network under the RMS current if the motor's file adds effects
  bool is_of_the_equations = true;      ///< true if `under_rms` comes from the equations
  bool is_over_limit = false;           ///< the highest temperature of the winding exceeds its limit, or there is no steady state

  /// Returns true if no steady state exists (thermal runaway).
  [[nodiscard]] bool is_runaway() const { return periodic.runaway; }
};

/// Computes the steady state of the motor at standstill, so that only copper loss heats it, as in the equations. Throws Failure
/// (numerics_failed) as periodic_state() does.
OnOffAnswer under_on_off_current(const Motor& motor, const thermal::OnOffCurrent& current);

}  // namespace heatsoak::motor
