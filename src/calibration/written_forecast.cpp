#include "calibration/written_forecast.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "estimation/interval.h"
#include "motor/motor.h"

namespace heatsoak {
namespace {

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

std::vector<OutsideDeclaredRange> outside_declared_ranges(const Motor& motor, std::span<const CalibratedParameter> parameters) {
  std::vector<OutsideDeclaredRange> found;
  Motor declared = motor;
  for (const CalibratedParameter& each : parameters) {
    const ParameterValue* const parameter = each.is_of_file ? find_parameter(declared, each.name) : nullptr;
    if (parameter && parameter->spread && (each.value < parameter->spread->low || each.value > parameter->spread->high)) {
      found.push_back({each.name, each.unit, each.value, parameter->spread->low, parameter->spread->high});
    }
  }
  return found;
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

std::vector<CalibrationFinding> forecast_findings(const Calibration& calibration) {
  const Forecast& forecast = *calibration.forecast;
  const bool is_written = calibration.is_forecast_written;
  std::vector<CalibrationFinding> found;
  if (is_written && !std::ranges::all_of(calibration.parameters, &CalibratedParameter::is_identifiable)) {
    found.push_back(UnidentifiableAreWritten{});
  }
  if (forecast.rivals.empty()) {
    const bool are_runs = std::ranges::all_of(forecast.pieces, [](const Piece& piece) { return piece.seen.empty(); });
    found.push_back(TooFewPieces{forecast.pieces.size(), kLeastPieces, calibration.runs.size(), are_runs});
  } else {
    found.push_back(CrossValidation{forecast.pieces.size(), forecast.rivals});
  }
  if (is_written && forecast.source == ForecastSource::tempered) {
    found.push_back(ForecastFitIsWritten{});
  }
  if (forecast.source == ForecastSource::file) {
    found.push_back(FilePredictsBest{is_written, is_better_than_innovations(forecast)});
  } else if (forecast.source == ForecastSource::ordinary) {
    found.push_back(FreeRunsPredictBest{is_written});
  } else if (!forecast.accepted.empty()) {
    ExtendedForForecasts extended{{}, is_written};
    std::ranges::transform(forecast.accepted, std::back_inserter(extended.effects), &AcceptedExtension::name);
    found.push_back(std::move(extended));
  }
  return found;
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
