// Periodic steady state of a network under inputs that repeat without end.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "thermal/transient.h"

namespace heatsoak::thermal {

/// Temperatures over one cycle after all transients have decayed; one entry per state node.
struct PeriodicState {
  /// True if no periodic solution stays below kDestroyed_C (thermal runaway or excessive heat). The temperatures are then empty.
  bool runaway = false;
  /// Time at which the first cycle from ambient exceeds kDestroyed_C; nothing if it does not.
  std::optional<double> destroyed_s;
  std::vector<double> start_C;
  std::vector<double> mean_C;
  std::vector<double> peak_C;  ///< includes maxima between the steps of the solver
};

/// Finds the state that one cycle maps to itself, by Newton's method from the ambient temperature of the first interval upwards. Unstable
/// cycles are passed over. A cycle shorter than a millionth of the fastest time constant is stretched to that length. Throws Failure
/// (numerics_failed) if the iteration does not converge.
PeriodicState periodic_state(const Network& network, std::span<const Interval> cycle);

}  // namespace heatsoak::thermal
