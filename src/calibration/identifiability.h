// Identifiability: parameter combinations that the data do not determine, and the cheapest experiment that would determine them.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "calibration/calibrate.h"

namespace heatsoak::calibration {

/// Returns true if the logged heat inputs of any run can warm the winding by at least 1 K.
bool is_heated(const MotorModel& motor, std::span<const estimation::MeasuredRun> runs);

/// Returns true if a common factor on all heat changes the parameter: values in K/W and J/K, not time constants.
bool depends_on_heat(const MotorModel& motor, const CalibratedValue& parameter);

/// Returns why parameters are not identifiable, as `parameters` state: because of a combination that the data determine less well than the
/// prior, or for another reason. `parameters` must be in the order of motor.parameters.
std::vector<OpenDirection> open_directions(const MotorModel& motor, const estimation::Fit& fit,
                                           std::span<const estimation::MeasuredRun> runs, std::span<const CalibratedParameter> parameters);

/// Returns the cheapest experiment for the most uncertain directions; nullopt if nothing is open.
std::optional<Remedy> next_experiment(std::span<const OpenDirection> open);

}  // namespace heatsoak::calibration
