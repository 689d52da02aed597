// Loggers' habits brought to one: what a row's heat inputs stand for, and whose clock they follow.
#pragma once

#include <span>

#include "identify/measurement/mapping.h"
#include "identify/measurement/recording.h"

namespace heatsoak {

/// Makes heat inputs and surroundings, recorded with `habit`, stand for the interval that begins at their row (currents by
/// their square, so that the copper loss stays), and moves channels whose clock is off by `offsets_s` (one per channel) to the rows' times:
/// inputs by averaging what was held, other channels on the straight line between neighbours. The last row of a run has no interval
/// where the habit is another than held: its inputs become NaN.
void to_interval_values(Recording& recording, InputHabit habit, std::span<const double> offsets_s);

}  // namespace heatsoak
