// Which parameters a calibration writes: those of the innovations fit, or those of the forecast fit where whole runs contradict it.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "identify/calibration/calibrate.h"

namespace heatsoak {

/// Both fits estimate the same parameters where the model is right, and the innovations fit is then the better one; whole runs reject it
/// beyond 95 % by a likelihood-ratio test (after Hausman 1978). An accepted extension, or a file that no fit improves, decides without a
/// test.
bool is_rejected_by_whole_runs(const Forecast& forecast, std::span<const MeasuredRun> runs, const Eigen::VectorXd& theta, int threads);

/// Puts the forecast's model, parameters and intervals in place of those of the innovations fit.
void write_forecast(Calibration& calibration);

/// What was compared and taken, in sentences.
std::vector<std::string> forecast_in_words(const Calibration& calibration);

/// Adds to the motor the effects and sensor faults that the forecast has beside those of the file.
void add_extensions(const Calibration& calibration, const std::string& source, Motor& motor);

/// Of a figure of the motor, by its key ("effects.fan.conductance"), in the figure's unit.
Range declared_range(const Motor& motor, std::string_view key);

}  // namespace heatsoak
