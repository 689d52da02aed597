#include "calibration/written_forecast.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "estimation/interval.h"
#include "estimation/open_loop.h"
#include "estimation/thresholds.h"
#include "motor/motor.h"

namespace heatsoak::calibration {
namespace {

bool is_better_than_innovations(const Forecast& forecast) {
  if (forecast.rivals.empty()) {
    return false;
  }
  const auto rival = [&](ForecastSource source) { return *std::ranges::find(forecast.rivals, source, &RivalScore::source); };
  const RivalScore best = rival(forecast.source);
  const RivalScore other = rival(ForecastSource::innovations);
  const auto matters = [&](const auto& signal_and_error) {
    const auto same = std::ranges::find(best.expected_K, signal_and_error.first, [](const auto& each) { return each.first; });
    return same == best.expected_K.end() || signal_and_error.second > same->second + estimation::thresholds().matters_K;
  };
  return other.score_nats > best.score_nats + kLeastGain_nats && std::ranges::any_of(other.expected_K, matters);
}

/// Returns the matrix of ones and zeros that selects, for each coordinate of `to`, the one with the same name in `from`; a row of zeros if
/// there is none.
Eigen::MatrixXd shared_coordinates(const estimation::Model& from, const estimation::Model& to) {
  Eigen::MatrixXd shared = Eigen::MatrixXd::Zero(to.free_count(), from.free_count());
  for (Eigen::Index i = 0; i < to.free_count(); ++i) {
    for (Eigen::Index j = 0; j < from.free_count(); ++j) {
      shared(i, j) = to.name(i) == from.name(j) ? 1.0 : 0.0;
    }
  }
  return shared;
}

/// Returns the smallest covariance that is in no direction below `one` (positive definite) or `other`.
Eigen::MatrixXd covering(const Eigen::MatrixXd& one, const Eigen::MatrixXd& other) {
  const Eigen::LLT<Eigen::MatrixXd> root(one);
  const Eigen::MatrixXd half = root.matrixL().solve(other);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> relative(root.matrixL().solve(half.transpose()));
  const Eigen::MatrixXd axes = root.matrixL() * relative.eigenvectors();
  return axes * relative.eigenvalues().cwiseMax(1.0).asDiagonal() * axes.transpose();
}

}  // namespace

void score_innovations(const ForecastModel& model, estimation::FitOptions options, Calibration& calibration,
                       const base::Progress& progress) {
  Forecast& forecast = *calibration.forecast;
  if (forecast.rivals.empty()) {
    return;
  }
  estimation::Model near = calibration.motor_model.model;
  near.values = near.values_at(calibration.fit.theta);
  options.starts = 0;
  const auto fit_without = [&](const Piece& piece) {
    estimation::Fit others = estimation::fit(near, runs_without(calibration.runs, piece), options);
    ForecastFit found;
    found.theta = std::move(others.theta);
    found.covariance = std::move(others.covariance);
    for (const std::vector<double>& start_C : others.start_C) {
      found.starts.push_back({Eigen::Map<const Eigen::VectorXd>(start_C.data(), std::ssize(start_C)), {}, {}});
    }
    return found;
  };
  std::size_t scored = 0;
  const auto after_piece = [&] {
    if (progress) {
      progress(++scored, forecast.pieces.size());
    }
  };
  const PieceScore score = score_pieces(model, calibration.runs, forecast.pieces, fit_without, after_piece);
  const PieceScore own = score_pieces(model, calibration.runs, forecast.pieces, calibration.fit.theta, nullptr);
  forecast.rivals.push_back(rival_score(ForecastSource::innovations, score, own, calibration.runs));
}

bool writes_forecast(WrittenFit wanted, const Forecast& forecast, bool follows_fitted_runs_better) {
  if (wanted != WrittenFit::best) {
    return wanted == WrittenFit::forecast;
  }
  if (forecast.rivals.empty()) {
    return follows_fitted_runs_better;
  }
  return forecast.source != ForecastSource::file && is_better_than_innovations(forecast);
}

base::Range possible_range(const motor::Motor& motor, std::string_view key) {
  for (const motor::MotorEffect& effect : motor.effects) {
    for (const base::ParameterSpec& spec : effect.type->parameters) {
      if (key == fmt::format("effects.{}.{}", effect.name, spec.key)) {
        return spec.range;
      }
    }
  }
  const auto specs = motor::motor_parameter_specs();
  const auto found = std::ranges::find(specs, key, [](const motor::MotorParameterSpec& each) { return each.spec.key; });
  return found == specs.end() ? base::Range::positive() : found->spec.range;
}

std::vector<OutsideDeclaredRange> outside_declared_ranges(const motor::Motor& motor, std::span<const CalibratedParameter> parameters) {
  std::vector<OutsideDeclaredRange> found;
  motor::Motor declared = motor;
  for (const CalibratedParameter& each : parameters) {
    const base::ParameterValue* const parameter = each.is_of_file ? motor::find_parameter(declared, each.name) : nullptr;
    if (parameter && parameter->spread && (each.value < parameter->spread->low || each.value > parameter->spread->high)) {
      found.push_back({each.name, each.unit, each.value, parameter->spread->low, parameter->spread->high});
    }
  }
  return found;
}

void carry_identifiability(const Forecast& forecast, std::span<const CalibratedParameter> before,
                           std::vector<CalibratedParameter>& parameters) {
  constexpr double kWider_ratio = 2.0;
  const auto width = [](const CalibratedParameter& each) { return std::log(each.high / each.low); };
  for (CalibratedParameter& each : parameters) {
    const auto same = std::ranges::find(before, each.name, &CalibratedParameter::name);
    if (same != before.end()) {
      const bool is_alike = forecast.accepted.empty() && width(each) < kWider_ratio * width(*same);
      each.is_identifiable = same->is_identifiable && (each.is_identifiable || is_alike);
    }
  }
}

void write_forecast(Calibration& calibration) {
  const Forecast& forecast = *calibration.forecast;
  const ForecastModel model = forecast.model();
  const Eigen::Index inner = model.motor().model.free_count();
  const estimation::Model before = calibration.motor_model.model;
  const Eigen::VectorXd theta_before = calibration.fit.theta;
  const Eigen::MatrixXd covariance_before = calibration.fit.covariance;
  calibration.motor_model = model.motor();
  calibration.fit.theta = forecast.fit.theta.head(inner);
  calibration.fit.covariance = forecast.fit.covariance.topLeftCorner(inner, inner);
  if (forecast.accepted.empty()) {
    const Eigen::MatrixXd shared = shared_coordinates(before, model.motor().model);
    const Eigen::VectorXd moved = shared * theta_before - shared.rowwise().sum().cwiseProduct(calibration.fit.theta);
    calibration.fit.covariance =
        covering(calibration.fit.covariance, moved * moved.transpose() + shared * covariance_before * shared.transpose());
  }
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
  if (forecast.pieces.size() < kLeastPieces) {
    const bool are_runs = std::ranges::all_of(forecast.pieces, [](const Piece& piece) { return piece.seen.empty(); });
    found.push_back(TooFewPieces{forecast.pieces.size(), kLeastPieces, calibration.runs.size(), are_runs});
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

std::vector<std::string> add_extensions(const Calibration& calibration, const std::string& source, motor::Motor& motor) {
  std::vector<std::string> names;
  for (const motor::MotorEffect& effect : calibration.effects) {
    if (std::ranges::find(motor.effects, effect.name, &motor::MotorEffect::name) != motor.effects.end()) {
      continue;
    }
    motor.effects.push_back(effect);
    names.push_back(effect.name);
    for (base::ParameterValue& each : motor.effects.back().parameters) {
      each.source = source;
      each.origin = each.spread ? each.origin : base::Origin::derived;
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
    const double reach = estimation::kInterval_sd * std::sqrt(fit.covariance(own, own));
    motor::MotorSensor sensor{std::string(fault.type->name), fault.type, {}};
    sensor.size.value = std::exp(fit.theta[own]);
    sensor.size.origin = base::Origin::measured;
    sensor.size.source = source;
    sensor.size.derivation = "fit to measured temperatures, for forecasts";
    sensor.size.spread = base::Spread{base::Spread::Kind::range, std::max(fault.type->size.range.low, sensor.size.value * std::exp(-reach)),
                                      std::min(fault.type->size.range.high, sensor.size.value * std::exp(reach)), true};
    names.push_back(sensor.name);
    motor.sensors.push_back(std::move(sensor));
  }
  return names;
}

}  // namespace heatsoak::calibration
