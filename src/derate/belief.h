// Which values of a signal the guard believes, and what it assumes where it believes none: the same for generated code and for the host.
#pragma once

#include <vector>

#include "derate/derating.h"

namespace heatsoak {

/// A neighbour that reads this much less than the air has no working sensor: the lower bound of its belief moves with the air.
inline constexpr float kNeighbourBelowAir_K = 5.0F;

/// In single precision, as the controller compares.
struct Belief {
  bool is_used = false;  ///< false: no law of the motor depends on the signal
  float low = 0.0F;      ///< of the neighbour: not used, see kNeighbourBelowAir_K
  float high = 0.0F;
  std::vector<float> values;  ///< that are possible, among them those that heat winding and bodies most; empty where not used
};

Belief belief(const Derating& derating, firmware::Signal signal);

}  // namespace heatsoak
