// Checks whether a log can be used to fit a motor. Runs before any simulation.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "motor/motor.h"
#include "recording/quality.h"
#include "recording/recording.h"

namespace heatsoak::calibration {

struct Admission {
  std::vector<std::string> notes;       ///< sentences for the user: properties of the logs that look wrong but may be right
  std::vector<std::string> next_steps;  ///< sentences for the user: what to change before recording more runs
};

/// Checks all logs and returns notes. Throws one Failure that lists the findings of every log:
/// - bad_input if rows are given twice, or are both fitted and held out;
/// - bad_input if units, signs or sensors look wrong in themselves or for this motor (only notes if `takes_logs_as_they_are`);
/// - cannot_answer if a fitted log contains no information about heat.
/// `ambient_C` is the user's air temperature for logs without one.
Admission admit(const motor::Motor& motor, std::span<const recording::Recording> fitted, std::span<const recording::Recording> held_out,
                bool takes_logs_as_they_are, std::optional<double> ambient_C = {});

/// Returns true if the fit used rows of this recording. Compares fingerprints of the content; older fit files stored only the name.
bool was_fitted_to(const motor::MotorFit& fit, const recording::Recording& recording);

/// Throws Failure (bad_input) if the motor file was already fitted to rows of one of the logs: that run would count twice.
void refuse_runs_of_the_file(const motor::Motor& motor, std::span<const recording::Recording> fitted,
                             std::span<const recording::Recording> held_out);

}  // namespace heatsoak::calibration
