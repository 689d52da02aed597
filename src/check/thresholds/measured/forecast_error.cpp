#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "check/computations.h"
#include "identify/calibration/motor_model.h"
#include "identify/measurement/read_recording.h"
#include "identify/open_loop.h"

namespace heatsoak::thresholds {
namespace {

std::vector<Recording> recordings_of(const Check& check) {
  if (check.logs.empty()) {
    throw Failure(ExitCode::bad_input, "the list of logs is empty");
  }
  std::vector<Recording> all;
  for (const std::filesystem::path& log : check.logs) {
    RecordingReport report;
    all.push_back(read_recording(log, mapping_for(log, check.mapping), report));
  }
  return all;
}

bool has(const std::vector<Signal>& signals, Signal signal) { return std::ranges::find(signals, signal) != signals.end(); }

Measured measure(const Check& check, Computations& /*computations*/) {
  const std::vector<Recording> recordings = recordings_of(check);
  const bool have_speed = std::ranges::all_of(recordings, [](const Recording& each) { return has(signals_of(each), Signal::speed); });
  const MotorModel model = motor_model(*check.motor, heat_input_for(recordings), have_speed);
  MeasuredRunOptions how = how_to_read(*check.motor);
  how.needed = model.needed;
  how.ambient_C = check.air_C;
  if (have_speed && has(how.needed, Signal::current) && !has(how.needed, Signal::speed)) {
    how.needed.push_back(Signal::speed);
  } else if (!have_speed) {
    std::erase(how.needed, Signal::speed);
  }
  std::vector<MeasuredRun> runs;
  for (const Recording& recording : recordings) {
    std::ranges::move(measured_runs(recording, how).runs, std::back_inserter(runs));
  }
  const std::vector<SignalError> errors = open_loop_error(model.model.network, model.model.values, runs);
  std::string detail;
  double worst_K = std::numeric_limits<double>::quiet_NaN();
  for (const SignalError& each : errors) {
    if (each.samples == 0) {
      continue;
    }
    worst_K = std::fmax(worst_K, each.rmse_K);
    detail += fmt::format("{}{} {:.2f} K rms, {:.1f} K at most", detail.empty() ? "" : "; ", each.signal, each.rmse_K, each.max_abs_K);
  }
  if (detail.empty()) {
    throw Failure(ExitCode::cannot_answer, "the logs have no temperature to compare with");
  }
  return {worst_K, 0.0, detail};
}

}  // namespace

ThresholdType forecast_error() {
  return {.name = {},
          .unit = "K",
          .range = Range::between(0.0, 1e3),
          .meaning =
              "how far the motor's model is off committed logs (root mean square, the worst of the measured temperatures): it runs "
              "freely over each run with the log's currents, speeds and air from the start that its first samples decide",
          .example = "at most 5 K",
          .needs = {Setting::motor, Setting::logs},
          .takes = {Setting::conditions, Setting::mapping, Setting::air},
          .measure = measure};
}

}  // namespace heatsoak::thresholds
