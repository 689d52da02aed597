// A wheel motor whose stator is bolted to a chassis that absorbs heat. The data sheet's two-node model lacks the chassis.
#pragma once

#include <cstdint>
#include <vector>

#include "truth_motor.h"

namespace heatsoak::attribution::truth {

/// Id of its motor file.
inline constexpr const char* kSoakMotor = "maxon_ec45_flat_70w_24v";

/// Returns three matches of 20 min and then a run on the bench of 30 min. Another seed gives other loads, noise and unknown heat.
std::vector<TrueRun> soak_runs(std::uint64_t seed);

}  // namespace heatsoak::attribution::truth
