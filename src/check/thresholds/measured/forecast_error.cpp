#include <cmath>
#include <limits>

#include "calibration/forecast/prediction.h"
#include "check/computations.h"
#include "check/not_evaluated.h"
#include "recording/read_recording.h"

namespace heatsoak::check::thresholds {
namespace {

std::vector<recording::Recording> recordings_of(const Check& check) {
  if (check.logs.empty()) {
    throw NotEvaluated(NoLogs{});
  }
  std::vector<recording::Recording> all;
  for (const std::filesystem::path& log : check.logs) {
    recording::RecordingReport report;
    all.push_back(recording::read_recording(log, recording::mapping_for(log, check.mapping), report));
  }
  return all;
}

Measured measure_forecast_error(const Check& check, Computations& /*computations*/) {
  const calibration::Prediction prediction = calibration::predict(*check.motor, recordings_of(check), {.ambient_C = check.air_C});
  ForecastBasis basis;
  double worst_K = std::numeric_limits<double>::quiet_NaN();
  for (const calibration::PredictedRun& run : prediction.runs) {
    for (const calibration::PredictedSignal& each : run.signals) {
      if (each.samples > 0) {
        worst_K = std::fmax(worst_K, each.rmse_K);
        basis.signals.push_back({run.name, each.signal, each.rmse_K, each.max_abs_K});
      }
    }
  }
  if (basis.signals.empty()) {
    throw NotEvaluated(NoMeasuredTemperature{});
  }
  return {worst_K, 0.0, basis};
}

/// A model that is wrong by the whole range of the motor's temperatures predicts nothing.
std::optional<LoosestLimit> whole_range(const Check& check) {
  constexpr double kUsualAir_C = 25.0;
  return check.motor ? std::optional<LoosestLimit>(
                           {check.motor->nominal.winding_limit_C - check.air_C.value_or(kUsualAir_C), LoosestBy::temperature_range, true})
                     : std::nullopt;
}

}  // namespace

ThresholdType forecast_error() {
  return {.name = {},
          .unit = "K",
          .range = base::Range::between(0.0, 1e3),
          .meaning =
              "error of the motor's model on committed logs (root mean square, the worst of the runs and measured temperatures): a "
              "free-running simulation of each run with the log's currents, speeds and air, started from its first samples",
          .example = "at most 5 K",
          .needs = {Setting::motor, Setting::logs},
          .takes = {Setting::conditions, Setting::mapping, Setting::air},
          .loosest = whole_range,
          .measure = measure_forecast_error};
}

}  // namespace heatsoak::check::thresholds
