#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "calibration/forecast/prediction.h"
#include "check/computations.h"
#include "recording/read_recording.h"

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

Measured measure(const Check& check, Computations& /*computations*/) {
  const Prediction prediction = predict(*check.motor, recordings_of(check), {.ambient_C = check.air_C});
  std::string detail;
  double worst_K = std::numeric_limits<double>::quiet_NaN();
  for (const PredictedRun& run : prediction.runs) {
    for (const PredictedSignal& each : run.signals) {
      if (each.samples > 0) {
        worst_K = std::fmax(worst_K, each.rmse_K);
        detail += fmt::format("{}{}: {} {:.2f} K rms, {:.1f} K at most", detail.empty() ? "" : "; ", run.name, each.signal, each.rmse_K,
                              each.max_abs_K);
      }
    }
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
              "error of the motor's model on committed logs (root mean square, the worst of the runs and measured temperatures): a "
              "free-running simulation of each run with the log's currents, speeds and air, started from its first samples",
          .example = "at most 5 K",
          .needs = {Setting::motor, Setting::logs},
          .takes = {Setting::conditions, Setting::mapping, Setting::air},
          .measure = measure};
}

}  // namespace heatsoak::thresholds
