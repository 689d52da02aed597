// What a network comes to under inputs that repeat for ever.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "thermal/transient.h"

namespace heatsoak {

/// Per state node, over one cycle once all cycles are alike.
struct PeriodicState {
  /// No cycle that repeats itself stays below kDestroyed_C: thermal runaway, or heat that nothing bears. There are no temperatures then.
  bool runaway = false;
  /// Where the very first cycle from ambient passes kDestroyed_C: when.
  std::optional<double> destroyed_s;
  std::vector<double> start_C;
  std::vector<double> mean_C;
  std::vector<double> peak_C;  ///< between the steps of the solver too
};

/// Solves state after a cycle = state before it by Newton's method, from the ambient temperature of the first interval upwards; an
/// unstable cycle is left behind. A cycle shorter than a millionth of the fastest time constant is taken as one of that length.
/// Throws Failure (numerics_failed) where the iteration does not converge.
PeriodicState periodic_state(const Network& network, std::span<const Interval> cycle);

}  // namespace heatsoak
