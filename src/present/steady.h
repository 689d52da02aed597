// Formats the answer of `steady` as a document.
#pragma once

#include "motor/motor.h"
#include "present/document.h"
#include "thermal/periodic_state.h"
#include "thermal/steady_state.h"

namespace heatsoak::present {

struct SteadyAnswer {
  const Motor& motor;
  const PeriodicState& periodic;      ///< result for the whole network
  const OnOffSteadyState& under_rms;  ///< equations (8) to (12), or the network under the RMS current if the file adds effects
  bool is_of_the_equations = true;    ///< true if `under_rms` comes from the equations
  double ambient_C = 25.0;
  bool is_over_limit = false;
};
Document steady_document(const SteadyAnswer& answer);

}  // namespace heatsoak::present
