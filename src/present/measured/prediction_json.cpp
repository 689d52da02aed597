#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/number_ranges.h"
#include "present/measured/calibration_words.h"
#include "present/measured/log.h"
#include "present/measured/prediction.h"

namespace heatsoak::present {

Json runs_json(const std::vector<calibration::PredictedRun>& runs) {
  Json all = Json::array();
  for (const calibration::PredictedRun& run : runs) {
    Json error = Json::object();
    Json coverage = Json::object();
    for (const calibration::PredictedSignal& each : run.signals) {
      error[each.signal] = {{"rmse_K", rounded(each.rmse_K, 4)}, {"max_abs_K", rounded(each.max_abs_K, 4)}, {"samples", each.samples}};
      coverage[each.signal] = rounded(each.coverage_share, 4);
    }
    all.push_back({{"name", run.name}, {"error", error}, {"coverage_90", coverage}});
  }
  return all;
}

Json band_json(const motor::ForecastBand& band) {
  // Six significant digits are the same on every machine.
  const auto number = [](double value) { return std::stod(fmt::format("{:.6g}", value)); };
  return {{"unknown_heat_winding_share", number(band.unknown_heat_share[0])},
          {"unknown_heat_stator_share", number(band.unknown_heat_share[1])},
          {"time_scale_s", number(band.time_scale_s)},
          {"heat_factor_sd", number(band.heat_factor_sd)},
          {"width_ratio", number(band.width_ratio)}};
}

Json prediction_json(const motor::Motor& motor, const calibration::PredictionAnswer& answer,
                     std::span<const recording::LogReading> readings) {
  Json json = {{"schema", "heatsoak.prediction/1"},
               {"motor", fitted_motor(motor)},
               {"model", motor.file.string()},
               {"runs", runs_json(answer.prediction.runs)}};
  add_notes(json, prediction_notes(answer, readings));
  return base::with_ranges(std::move(json),
                           {{"rmse_K", base::kNotNegative}, {"max_abs_K", base::kNotNegative}, {"coverage_90", base::kShare}});
}

}  // namespace heatsoak::present
