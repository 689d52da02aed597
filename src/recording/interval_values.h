// Converts heat inputs to interval values: different conventions and clock offsets of loggers become the canonical form.
#pragma once

#include <span>

#include "recording/mapping.h"
#include "recording/recording.h"

namespace heatsoak::recording {

/// Converts heat inputs and surroundings, recorded with `convention`, to values of the interval that begins at their row. Currents
/// are converted by their squares, which conserves the copper loss. Shifts channels by `offsets_s` (one per channel) to the rows' times:
/// inputs by averaging, other channels by linear interpolation. Unless the convention is `held`, the inputs of a run's last row become NaN.
void to_interval_values(Recording& recording, InputConvention convention, std::span<const double> offsets_s);

}  // namespace heatsoak::recording
