// The answer of `calibrate`: checks the logs, fits the motor's parameters to them, and makes the calibrated motor.
#pragma once

#include "calibration/admission.h"
#include "calibration/calibrate.h"
#include "recording/named_logs.h"

namespace heatsoak::calibration {

struct CalibrationJob {
  motor::Motor motor;         ///< start of the fit and prior knowledge
  recording::NamedLogs logs;  ///< their choice states whether logs that look wrong are accepted
  estimation::FitOptions fit;
  WrittenFit written = WrittenFit::best;
};

struct CalibrationAnswer {
  Calibration calibration;
  motor::Motor motor;  ///< the calibrated motor
  Admission admission;
};

/// Throws Failure as admit(), refuse_runs_of_the_file() and calibrate() do.
CalibrationAnswer run_calibration(const CalibrationJob& job, const base::JobProgress& progress = {});

}  // namespace heatsoak::calibration
