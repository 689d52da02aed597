#include "calibration/calibration_job.h"

namespace heatsoak::calibration {

CalibrationAnswer run_calibration(const CalibrationJob& job) {
  const recording::LogChoice& choice = job.logs.choice;
  if (!choice.takes_logs_as_they_are) {
    refuse_runs_of_the_file(job.motor, job.logs.fitted, job.logs.held_out);
  }
  Admission admission = admit(job.motor, job.logs.fitted, job.logs.held_out, choice.takes_logs_as_they_are, choice.ambient_C);
  Calibration calibration = calibrate(job.motor, job.logs.fitted, job.logs.held_out, {job.fit, choice.ambient_C, job.written});
  motor::Motor calibrated = calibrated_motor(job.motor, calibration);
  return {std::move(calibration), std::move(calibrated), std::move(admission)};
}

}  // namespace heatsoak::calibration
