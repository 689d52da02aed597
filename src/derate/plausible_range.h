// Plausible range of each input signal, and the values that the guard assumes for an implausible reading. Shared by generated code and
// host.
#pragma once

#include <vector>

#include "derate/derating.h"

namespace heatsoak::derate {

/// A neighbouring motor that reads this much below the air temperature has a faulty sensor. Its lower bound therefore follows the air.
inline constexpr float kNeighbourBelowAir_K = 5.0F;

/// Highest temperature of a node of the generated observer, in °C: winding and magnets are destroyed long before. Numbers that follow from
/// the state stay within the range of the fixed-point form. Also the bound of a plausible reading or saved temperature.
inline constexpr float kMostState_C = 1000.0F;

/// Plausible range of one signal, in the signal's unit. Single precision, because the controller compares in it.
struct PlausibleRange {
  bool is_used = false;  ///< false: no law of the motor depends on the signal
  float low = 0.0F;      ///< not used for the neighbour, see kNeighbourBelowAir_K
  float high = 0.0F;
  std::vector<float> values;  ///< possible values, including those that heat winding and bodies most; empty if the signal is not used
};

/// Returns the plausible range of a signal; all members have their defaults if no law of the motor depends on it.
PlausibleRange plausible_range(const Derating& derating, observed::Signal signal);

}  // namespace heatsoak::derate
