#include "calibration/written_forecast.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/quantity.h"
#include "estimation/interval.h"
#include "motor/motor.h"

namespace heatsoak {
namespace {

std::string_view name_of(ForecastSource source) {
  switch (source) {
    case ForecastSource::file:
      return "file";
    case ForecastSource::ordinary:
      return "least squares of free runs";
    case ForecastSource::tempered:
      return "forecast fit";
    case ForecastSource::innovations:
      return "innovations fit";
  }
  return "?";
}

std::string errors_in_words(const RivalScore& rival) {
  std::vector<std::string> each;
  for (const auto& [signal, rmse_K] : rival.rmse_K) {
    each.push_back(fmt::format("{} {} K", signal.substr(0, signal.rfind('_')), significant(rmse_K, 2)));
  }
  return fmt::format("{}: {}", name_of(rival.source), fmt::join(each, ", "));
}

bool is_better_than_innovations(const Forecast& forecast) {
  const auto score_nats = [&](ForecastSource source) {
    return std::ranges::find(forecast.rivals, source, &RivalScore::source)->score_nats;
  };
  return !forecast.rivals.empty() && score_nats(ForecastSource::innovations) > score_nats(forecast.source) + kLeastGain_nats;
}

}  // namespace

void score_innovations(const ForecastModel& model, FitOptions options, Calibration& calibration) {
  Forecast& forecast = *calibration.forecast;
  if (forecast.rivals.empty()) {
    return;
  }
  Model near = calibration.motor_model.model;
  near.values = near.values_at(calibration.fit.theta);
  options.starts = 0;
  const auto fit_without = [&](const Piece& piece) {
    Fit others = fit(near, runs_without(calibration.runs, piece), options);
    ForecastFit found;
    found.theta = std::move(others.theta);
    found.covariance = std::move(others.covariance);
    found.starts = std::move(others.starts);
    return found;
  };
  const PieceScore score = score_pieces(model, calibration.runs, forecast.pieces, fit_without);
  forecast.rivals.push_back(rival_score(ForecastSource::innovations, score, calibration.runs));
}

bool writes_forecast(WrittenFit wanted, const Forecast& forecast) {
  if (wanted != WrittenFit::best) {
    return wanted == WrittenFit::forecast;
  }
  const bool are_runs = std::ranges::all_of(forecast.pieces, [](const Piece& piece) { return piece.seen.empty(); });
  return are_runs && forecast.source != ForecastSource::file && is_better_than_innovations(forecast);
}

Range declared_range(const Motor& motor, std::string_view key) {
  for (const MotorEffect& effect : motor.effects) {
    for (const ParameterSpec& spec : effect.type->parameters) {
      if (key == fmt::format("effects.{}.{}", effect.name, spec.key)) {
        return spec.range;
      }
    }
  }
  const auto specs = motor_parameter_specs();
  const auto found = std::ranges::find(specs, key, [](const MotorParameterSpec& each) { return each.spec.key; });
  return found == specs.end() ? Range::positive() : found->spec.range;
}

std::vector<std::string> outside_declared_ranges(const Motor& motor, std::span<const CalibratedParameter> parameters) {
  std::vector<std::string> notes;
  Motor declared = motor;
  for (const CalibratedParameter& each : parameters) {
    const ParameterValue* const parameter = each.is_of_file ? find_parameter(declared, each.name) : nullptr;
    if (parameter && parameter->spread && (each.value < parameter->spread->low || each.value > parameter->spread->high)) {
      notes.push_back(
          fmt::format("{} becomes {} {}, outside of its declared range of {} to {} {}: check the units of the logs, or whether "
                      "the range still holds for this motor and its mounting",
                      each.name, significant(each.value, 3), unit_for_display(each.unit), significant(parameter->spread->low, 3),
                      significant(parameter->spread->high, 3), unit_for_display(each.unit)));
    }
  }
  return notes;
}

void keep_unidentifiable(std::span<const CalibratedParameter> before, std::vector<CalibratedParameter>& parameters) {
  for (CalibratedParameter& each : parameters) {
    const auto same = std::ranges::find(before, each.name, &CalibratedParameter::name);
    each.is_identifiable = each.is_identifiable && (same == before.end() || same->is_identifiable);
  }
}

void write_forecast(Calibration& calibration) {
  const Forecast& forecast = *calibration.forecast;
  const ForecastModel model = forecast.model();
  const Eigen::Index inner = model.motor().model.free_count();
  calibration.motor_model = model.motor();
  calibration.fit.theta = forecast.fit.theta.head(inner);
  calibration.fit.covariance = forecast.fit.covariance.topLeftCorner(inner, inner);
  constexpr double kLeast_K = 1e-3;
  constexpr double kMost_K = 20.0;
  calibration.fit.free_run_error_K = std::clamp(forecast.fit.error_K, kLeast_K, kMost_K);
  calibration.is_forecast_written = true;
}

std::string what_does_not_describe(const Calibration& calibration) {
  const bool is_extended = calibration.is_forecast_written && !calibration.forecast->accepted.empty();
  return fmt::format("{} constant values do not describe this motor",
                     is_extended ? "the extended network and its" : "two temperatures with");
}

std::vector<std::string> forecast_in_words(const Calibration& calibration) {
  const Forecast& forecast = *calibration.forecast;
  std::vector<std::string> words;
  if (calibration.is_forecast_written && !std::ranges::all_of(calibration.parameters, &CalibratedParameter::is_identifiable)) {
    words.emplace_back(
        "values that are not identifiable are written too: the forecast depends on all values together, so do not use these as "
        "measurements");
  }
  if (forecast.rivals.empty()) {
    words.push_back(
        fmt::format("the network is not extended and the 90 % band of forecasts is wide, because cross-validation can leave out only {} "
                    "runs that contain heat, and needs at least {}",
                    forecast.pieces.size(), kLeastPieces));
  } else {
    std::vector<std::string> each;
    std::ranges::transform(forecast.rivals, std::back_inserter(each), errors_in_words);
    words.push_back(
        fmt::format("cross-validation error of the left-out pieces ({}), rms: {}", forecast.pieces.size(), fmt::join(each, "; ")));
  }
  if (calibration.is_forecast_written && forecast.source == ForecastSource::tempered) {
    words.emplace_back("the parameters of the forecast fit are written: they follow whole runs best, not the response within seconds");
  }
  if (forecast.source == ForecastSource::file) {
    words.emplace_back(calibration.is_forecast_written
                           ? "no fit predicts left-out pieces better than the file: its values are written as they are"
                       : is_better_than_innovations(forecast)
                           ? "for forecasts the values of the file are better than the written ones: they predict left-out pieces better"
                           : "no fit predicts left-out pieces better than the file, but the written values predict them as well");
  } else if (forecast.source == ForecastSource::ordinary) {
    words.push_back(fmt::format("least squares of free runs predicts left-out pieces best: {}",
                                calibration.is_forecast_written ? "its parameters are written" : "`--forecast` writes its parameters"));
  } else if (!forecast.accepted.empty()) {
    std::vector<std::string> names;
    std::ranges::transform(forecast.accepted, std::back_inserter(names), &AcceptedExtension::name);
    words.push_back(fmt::format("{} {}; this is no diagnosis: another effect may be the cause (`heatsoak diagnose`)",
                                calibration.is_forecast_written
                                    ? "for better forecasts the network now has"
                                    : "left-out pieces are predicted best by a network that `--forecast` writes, with",
                                fmt::join(names, ", ")));
  }
  return words;
}

std::vector<std::string> add_extensions(const Calibration& calibration, const std::string& source, Motor& motor) {
  std::vector<std::string> names;
  for (const MotorEffect& effect : calibration.effects) {
    if (std::ranges::find(motor.effects, effect.name, &MotorEffect::name) != motor.effects.end()) {
      continue;
    }
    motor.effects.push_back(effect);
    names.push_back(effect.name);
    for (ParameterValue& each : motor.effects.back().parameters) {
      each.source = source;
      each.origin = each.spread ? each.origin : Origin::derived;
    }
  }
  if (!calibration.is_forecast_written || calibration.forecast->accepted.empty()) {
    return {};
  }
  const ForecastModel model = calibration.forecast->model();
  const ForecastFit& fit = calibration.forecast->fit;
  for (std::size_t i = 0; i < model.faults().size(); ++i) {
    const FreeFault& fault = model.faults()[i];
    const Eigen::Index own = model.motor().model.free_count() + static_cast<Eigen::Index>(i);
    const double reach = kInterval_sd * std::sqrt(fit.covariance(own, own));
    MotorSensor sensor{std::string(fault.type->name), fault.type, {}};
    sensor.size.value = std::exp(fit.theta[own]);
    sensor.size.origin = Origin::measured;
    sensor.size.source = source;
    sensor.size.derivation = "fit to measured temperatures, for forecasts";
    sensor.size.spread = Spread{Spread::Kind::range, std::max(fault.type->size.range.low, sensor.size.value * std::exp(-reach)),
                                std::min(fault.type->size.range.high, sensor.size.value * std::exp(reach)), true};
    names.push_back(sensor.name);
    motor.sensors.push_back(std::move(sensor));
  }
  return names;
}

}  // namespace heatsoak
