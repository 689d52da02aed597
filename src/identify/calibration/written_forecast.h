// Which parameters a calibration writes: those of the innovations fit, or on demand those of the forecast fit.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "identify/calibration/calibrate.h"

namespace heatsoak {

/// Returns one sentence per fitted value outside its declared range. Verbs that need a sound motor may refuse such a file.
std::vector<std::string> outside_declared_ranges(const Motor& motor, std::span<const CalibratedFigure> figures);

/// Marks a value as not identifiable if it was not identifiable in `before`.
void keep_untold(std::span<const CalibratedFigure> before, std::vector<CalibratedFigure>& figures);

/// Puts the forecast's model, parameters and intervals in place of those of the innovations fit.
void write_forecast(Calibration& calibration);

/// The network that is written and its values, as what a motor is not described by.
std::string what_does_not_describe(const Calibration& calibration);

/// What was compared and taken, in sentences.
std::vector<std::string> forecast_in_words(const Calibration& calibration);

/// Adds to the motor the effects and sensor faults that the forecast has beside those of the file.
void add_extensions(const Calibration& calibration, const std::string& source, Motor& motor);

/// Of a figure of the motor, by its key ("effects.fan.conductance"), in the figure's unit.
Range declared_range(const Motor& motor, std::string_view key);

}  // namespace heatsoak
