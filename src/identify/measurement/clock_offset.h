// Does the temperature answer when the heat changes? By how much the heat must be moved in time to explain it best.
#pragma once

#include <string>

#include "identify/measurement/quality.h"
#include "identify/measurement/recording.h"

namespace heatsoak {

/// Fits changes of `temperature` by the heat that went in, moved by a delay, and the mean temperatures meanwhile (linear, no model of
/// the motor); the delay with the least error wins. `noise_K` is the temperature's standard deviation.
ClockOffset clock_offset(const Recording& recording, const Channel& temperature, const Channel& heat_input, double noise_K);

/// What to say where the winding surely answers before its heat, in logs with rows of `period_s`; else empty. Nothing does: a clock is
/// wrong.
std::string early_answer(const ClockOffset& offset, double period_s);
/// What to say where the winding surely answers late, as with a sensor that lags; else empty.
std::string late_answer(const ClockOffset& offset, double period_s);

}  // namespace heatsoak
