#include "calibration/calibration_job.h"

#include <optional>
#include <utility>

#include "base/collected_failures.h"

namespace heatsoak::calibration {

CalibrationAnswer run_calibration(const CalibrationJob& job, const base::JobProgress& progress) {
  const recording::LogChoice& choice = job.logs.choice;
  base::CollectedFailures failures;
  if (!choice.takes_logs_as_they_are) {
    failures.attempt([&] { refuse_runs_of_the_file(job.motor, job.logs.fitted, job.logs.held_out); });
  }
  std::optional<Admission> admission = failures.attempt([&] { return admit(job.motor, job.logs); });
  failures.throw_if_any();
  Calibration calibration = calibrate(job.motor, job.logs.fitted, job.logs.held_out, {job.fit, choice.ambient_C, job.written, progress});
  motor::Motor calibrated = calibrated_motor(job.motor, calibration);
  return {std::move(calibration), std::move(calibrated), *std::move(admission)};
}

}  // namespace heatsoak::calibration
