// Rows in which a motor reverses. There, the mean of the signed speed is smaller than the mean magnitude, which determines the losses.
#pragma once

#include <optional>
#include <vector>

#include "estimation/measured_run.h"
#include "estimation/model.h"

namespace heatsoak::estimation {

/// True if the motor may reverse within a row: the speeds of the row and its two neighbours have both signs.
bool may_turn_within_rows(const MeasuredRun& run);

/// Returns the run with new mean and RMS speeds of such rows: for a speed that varies linearly from the row before to the row after,
/// instead of a constant speed. Rows that are means of finer rows are not changed.
MeasuredRun turning_within_rows(MeasuredRun run);
std::vector<MeasuredRun> turning_within_rows(std::vector<MeasuredRun> runs);

/// Decides by the evidence of the model whether the speed varies linearly within such rows. If it does, replaces the runs by
/// turning_within_rows(). Returns nothing if no run has such rows. Throws Failure as first_fit() does.
std::optional<bool> settle_turning_rows(const Model& model, std::vector<MeasuredRun>& runs);

}  // namespace heatsoak::estimation
