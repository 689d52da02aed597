// What the data leave open, in words, and the cheapest experiment that would settle it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "identify/calibration/calibrate.h"

namespace heatsoak {

/// Whether any heat goes in that the logs tell of.
bool is_heated(const MotorModel& motor, std::span<const MeasuredRun> runs);

/// Whether the figure changes with a common factor on all heat, as K/W and J/K do and time constants do not.
bool rests_on_watts(const MotorModel& motor, const FittedFigure& figure);

/// Combinations of the parameters that the data tell worse than what was known before, and the figures that are not told for another
/// reason; `figures` as the model has them.
std::vector<OpenDirection> open_directions(const MotorModel& motor, const Fit& fit, std::span<const MeasuredRun> runs,
                                           std::span<const CalibratedFigure> figures);

/// The cheapest that answers what is most open; empty where nothing is.
std::string next_experiment(std::span<const OpenDirection> open);

}  // namespace heatsoak
