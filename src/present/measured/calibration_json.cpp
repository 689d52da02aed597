#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "base/number_ranges.h"
#include "calibration/written_forecast.h"
#include "present/measured/calibration.h"
#include "present/measured/calibration_words.h"
#include "present/measured/log.h"
#include "present/measured/prediction.h"

namespace heatsoak::present {
namespace {

Json error_json(const std::vector<calibration::ErrorBeforeAfter>& errors, bool after) {
  Json all = Json::object();
  for (const calibration::ErrorBeforeAfter& each : errors) {
    const estimation::SignalError& error = after ? each.after : each.before;
    all[each.signal] = {{"rmse_K", rounded(error.rmse_K, 4)}, {"max_abs_K", rounded(error.max_abs_K, 4)}, {"samples", error.samples}};
  }
  return all;
}

/// Rounds to six significant digits, which are the same on every machine.
Json number(double value) { return std::stod(fmt::format("{:.6g}", value)); }

Json forecast_json(const calibration::Calibration& calibration) {
  const calibration::Forecast& forecast = *calibration.forecast;
  constexpr std::array kSources{"file", "least_squares", "forecast_fit", "innovations_fit"};
  Json left_out = Json::object();
  for (const calibration::RivalScore& rival : forecast.rivals) {
    for (const auto& [signal, rmse_K] : rival.rmse_K) {
      left_out[kSources[static_cast<std::size_t>(rival.source)]][signal] = {{"rmse_K", rounded(rmse_K, 4)}};
    }
  }
  Json extensions = Json::array();
  for (const calibration::AcceptedExtension& each : forecast.accepted) {
    extensions.push_back({{"id", each.name}, {"nats", rounded(each.gain_nats, 3)}});
  }
  return {{"best", kSources[static_cast<std::size_t>(forecast.source)]},
          {"written", calibration.is_forecast_written ? kSources[static_cast<std::size_t>(forecast.source)] : kSources.back()},
          {"left_out_pieces", forecast.pieces.size()},
          {"left_out_error", left_out},
          {"extensions", extensions},
          {"band", band_json(forecast.band)}};
}

}  // namespace

Json calibration_json(const motor::Motor& motor, const calibration::CalibrationAnswer& answer,
                      std::span<const recording::LogReading> readings, const std::string& out) {
  const calibration::Calibration& result = answer.calibration;
  Json parameters = Json::array();
  for (const calibration::CalibratedParameter& each : result.parameters) {
    Json parameter{{"name", each.name},
                   {"value", number(each.value)},
                   {"unit", each.unit},
                   {"ci95", {number(each.low), number(each.high)}},
                   {"identifiable", each.is_identifiable},
                   {"before", number(each.before)},
                   {"interval", each.by_profile ? "profile_likelihood" : "curvature"}};
    if (calibration::possible_range(answer.motor, each.name).low >= 0.0) {
      parameter = base::with_ranges(std::move(parameter),
                                    {{"value", base::kNotNegative}, {"ci95", base::kNotNegative}, {"before", base::kNotNegative}});
    }
    parameters.push_back(std::move(parameter));
  }
  Json open = Json::array();
  for (const calibration::OpenDirection& each : result.open) {
    open.push_back({{"parameters", parameter_words(each)}, {"why", reason_words(each)}, {"experiment", words_of(each.remedy)}});
  }
  Json correlation = Json::array();
  for (Eigen::Index i = 0; i < result.correlation.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < result.correlation.cols(); ++j) {
      row.push_back(rounded(result.correlation(i, j), 4));
    }
    correlation.push_back(std::move(row));
  }
  Json json = {{"schema", "heatsoak.calibration/1"},
               {"motor", motor.id},
               {"runs", result.runs.size()},
               {"parameters", parameters},
               {"correlation", correlation},
               {"error", error_json(result.fit_error, true)},
               {"error_before", error_json(result.fit_error, false)},
               {"holdout_error", error_json(result.holdout_error, true)},
               {"holdout_error_before", error_json(result.holdout_error, false)},
               {"holdout", {{"before", runs_json(result.holdout_before)}, {"after", runs_json(result.holdout_after)}}},
               {"forecast", forecast_json(result)},
               {"latent_flux",
                {{"winding_W", number(result.fit.flux.rms_W[0])},
                 {"stator_W", number(result.fit.flux.rms_W[1])},
                 {"time_scale_s", number(result.fit.flux.time_scale_s)}}},
               {"rejected_share", number(result.fit.rejected_share(result.runs))},
               {"not_identifiable", open},
               {"next_experiment", next_steps_words(answer)},
               {"worse_than_before", words_of(result.worse)},
               {"model", out}};
  add_notes(json, calibration_notes(answer, readings));
  return base::with_ranges(std::move(json), {{"rmse_K", base::kNotNegative},
                                             {"max_abs_K", base::kNotNegative},
                                             {"latent_flux", base::kNotNegative},
                                             {"coverage_90", base::kShare},
                                             {"unknown_heat_winding_share", base::kNotNegative},
                                             {"unknown_heat_stator_share", base::kNotNegative},
                                             {"time_scale_s", base::kNotNegative},
                                             {"rejected_share", base::kShare}});
}

}  // namespace heatsoak::present
