// Does the temperature answer when the heat changes? By how much the heat must be moved in time to explain it best.
#pragma once

#include "identify/measurement/quality.h"
#include "identify/measurement/recording.h"

namespace heatsoak {

/// Fits changes of `temperature` by the heat that went in, moved by a delay, and the mean temperatures meanwhile (linear, no model of
/// the motor); the delay with the least error wins. `noise_K` is the temperature's standard deviation.
ClockOffset clock_offset(const Recording& recording, const Channel& temperature, const Channel& heat_input, double noise_K);

}  // namespace heatsoak
