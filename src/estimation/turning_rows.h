// Rows in which a motor reverses. There, the mean of the signed speed is smaller than the mean magnitude, which determines the losses.
#pragma once

#include "estimation/measured_run.h"

namespace heatsoak::estimation {

/// True if the motor may reverse within a row: the speeds of the row and its two neighbours have both signs.
bool may_turn_within_rows(const MeasuredRun& run);

/// Returns the run with new mean and RMS speeds of such rows: for a speed that varies linearly from the row before to the row after,
/// instead of a constant speed. Rows that are means of finer rows are not changed.
MeasuredRun turning_within_rows(MeasuredRun run);

}  // namespace heatsoak::estimation
