#include "diagnosis/model_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/diagnostic.h"
#include "base/quantity.h"
#include "calibration/admission.h"
#include "calibration/effect_signals.h"
#include "calibration/error_before_after.h"
#include "calibration/training_range.h"
#include "calibration/unlogged_speed.h"
#include "calibration/written_forecast.h"
#include "estimation/interval.h"
#include "estimation/log_columns.h"
#include "estimation/log_rows.h"
#include "motor/write_motor.h"
#include "recording/fingerprint.h"

namespace heatsoak::diagnosis {

NothingHeatsModel::NothingHeatsModel(const std::string& motor)
    : base::Failure(base::ExitCode::bad_input, "no log has a heat input for " + motor) {}

namespace {

/// Sets the signals that the logs must have, and adds a finding for each effect whose signals no log has.
void set_needed(ModelOfLogs& out, const motor::Motor& motor, const std::vector<recording::Recording>& recordings) {
  const std::vector<calibration::EffectNeeds> needs = calibration::needs_of(out.model);
  // Unless the file states that the input power is the heat, one log without a current is no reason to ignore the currents of the others.
  const bool is_stated = motor.fit && motor.fit->heat_input == out.heat;
  const auto has_current = [](const recording::Recording& each) { return estimation::has_signal(each, thermal::Signal::current); };
  if (out.heat == calibration::HeatInput::input_power && !is_stated && std::ranges::any_of(recordings, has_current)) {
    out.how.ignores_current = false;
  }
  calibration::EffectSignals signals = calibration::effect_signals(needs, recordings, out.how);
  const bool has_heat = std::ranges::any_of(
      signals.found, [](thermal::Signal each) { return each == thermal::Signal::current || each == thermal::Signal::input_power; });
  if (!has_heat) {
    throw NothingHeatsModel(motor.id);
  }
  out.how.needed = std::move(signals.found);
  std::ranges::move(signals.missing, std::back_inserter(out.findings));
}

constexpr const char* kSource = "diagnosis";

base::ParameterValue measured(double value, double low, double high, const base::Range& range) {
  base::ParameterValue parameter;
  parameter.value = value;
  parameter.origin = base::Origin::measured;
  parameter.source = kSource;
  if (low < value && high > value && low > 0.0) {
    parameter.spread = base::Spread{base::Spread::Kind::range, std::max(low, range.low), std::min(high, range.high), true};
  }
  return parameter;
}

motor::MotorSensor motor_sensor(const motor::SensorEffectType& type, const FittedParameter& size) {
  motor::MotorSensor sensor{std::string(type.name), &type, measured(size.value, size.low, size.high, type.size.range)};
  // An offset or a gain may have either sign, unlike a lag.
  if (size.low < size.value && size.value < size.high) {
    sensor.size.spread =
        base::Spread{base::Spread::Kind::range, std::max(size.low, type.size.range.low), std::min(size.high, type.size.range.high), false};
  }
  return sensor;
}

/// Adds the sensor error under an unused name.
void add_sensor(motor::Motor& motor, const motor::MotorSensor& sensor) {
  const auto is_used = [&](const std::string& name) {
    return std::ranges::find(motor.effects, name, &motor::MotorEffect::name) != motor.effects.end() ||
           std::ranges::find(motor.sensors, name, &motor::MotorSensor::name) != motor.sensors.end();
  };
  motor::MotorSensor added = sensor;
  for (int number = 2; is_used(added.name); ++number) {
    added.name = fmt::format("{}_{}", sensor.name, number);
  }
  motor.sensors.push_back(std::move(added));
}

motor::MotorEffect motor_effect(const FoundEffect& found, const estimation::Posterior& fit) {
  const thermal::Network& network = fit.model.network;
  const auto in_place = std::ranges::find(network.effects(), found.name, &thermal::EffectInPlace::name);
  motor::MotorEffect effect{found.name, in_place->type, {}, {}, found.condition};
  for (std::size_t role = 0; role < in_place->node_index.size(); ++role) {
    const bool is_own = in_place->type->nodes[role].own_capacity.has_value();
    effect.nodes.push_back(is_own ? found.name : std::string(network.node_name(in_place->node_index[role])));
  }
  for (std::size_t p = 0; p < in_place->parameter_index.size(); ++p) {
    const base::ParameterSpec& spec = in_place->type->parameters[p];
    const double value = fit.model.values[static_cast<std::size_t>(in_place->parameter_index[p])];
    if (!spec.choices.empty()) {
      base::ParameterValue chosen;
      chosen.value = value;
      const std::string_view name = spec.choices[static_cast<std::size_t>(value)].name;
      chosen.printed = thermal::is_column_choice(name) ? thermal::kColumnChoice : name;
      effect.parameters.push_back(chosen);
      effect.column = chosen.printed == thermal::kColumnChoice ? found.signals.front() : effect.column;
      continue;
    }
    const FittedParameter& fitted = *std::ranges::find(found.parameters, spec.key, &FittedParameter::name);
    effect.parameters.push_back(measured(value, fitted.low, fitted.high, spec.range));
  }
  return effect;
}

/// Writes the fitted values, intervals and correlations of the file's parameters.
void set_parameters(motor::Motor& motor, const ModelOfLogs& model, const estimation::Posterior& fit,
                    const std::vector<estimation::MeasuredRun>& runs) {
  const auto free = model.model.network_count();
  const Eigen::VectorXd moved = fit.model.theta().head(free) - model.model.theta();
  const Eigen::MatrixXd covariance = fit.covariance.topLeftCorner(free, free);
  std::vector<const calibration::CalibratedValue*> of_file;
  for (const calibration::CalibratedValue& each : model.parameters) {
    if (each.is_of_file) {
      of_file.push_back(&each);
    }
  }
  Eigen::MatrixXd exponents(static_cast<Eigen::Index>(of_file.size()), free);
  motor::MotorFit together;
  together.motor = motor.fit ? motor.fit->motor : motor.id;
  together.runs = model.fitted;
  together.heat_input = model.heat;
  together.is_speed_linear = model.is_speed_linear;
  together.training = model.training;
  for (std::size_t i = 0; i < of_file.size(); ++i) {
    const calibration::CalibratedValue& each = *of_file[i];
    exponents.row(static_cast<Eigen::Index>(i)) = each.exponents.transpose();
    const double sd = std::sqrt(std::max(0.0, each.exponents.dot(covariance * each.exponents)));
    base::ParameterValue& parameter = *motor::find_parameter(motor, each.name);
    const double value = each.before * std::exp(each.exponents.dot(moved));
    const std::string source = parameter.source;
    const base::Origin origin = parameter.origin;
    parameter = measured(value, value * std::exp(-estimation::kInterval_sd * sd), value * std::exp(estimation::kInterval_sd * sd),
                         calibration::possible_range(motor, each.name));
    parameter.derivation =
        source.empty() ? "fit to measured temperatures" : fmt::format("fit to measured temperatures; before the fit: {}", source);
    if (!calibration::is_identifiable(sd, each)) {
      parameter.origin = origin;
      parameter.source = motor::joined_sources(parameter.source, source);
      parameter.derivation = "fit to measured temperatures, which do not determine it alone";
    }
    together.parameters.push_back(each.name);
  }
  Eigen::MatrixXd correlation = exponents * covariance * exponents.transpose();
  const Eigen::VectorXd sd = correlation.diagonal().cwiseSqrt().cwiseMax(1e-9);
  correlation = sd.cwiseInverse().asDiagonal() * correlation * sd.cwiseInverse().asDiagonal();
  correlation.diagonal().setOnes();
  together.correlation = motor::Correlation(std::span<const double>(correlation.data(), static_cast<std::size_t>(correlation.size())));
  const estimation::LatentFlux flux = fit.flux;
  together.latent_flux_W = flux.rms_W;
  together.latent_flux_time_scale_s = flux.time_scale_s;
  std::map<std::string, double> noise_K;
  for (const estimation::MeasuredRun& run : runs) {
    for (const estimation::Sensor& sensor : run.sensors) {
      noise_K[sensor.node] = std::max(noise_K[sensor.node], sensor.noise_K);
    }
  }
  together.noise_K.assign(noise_K.begin(), noise_K.end());
  motor.fit = std::move(together);
}

/// If the file was fitted to some of these runs, resets its fitted parameters to the uncertainty of a data sheet. The runs would count
/// twice, and the intervals may belong to an incomplete model.
void forget_fit(motor::Motor& motor, const std::vector<recording::Recording>& recordings, std::vector<DiagnosisFinding>& findings) {
  const auto is_fitted = [&](const recording::Recording& each) { return calibration::was_fitted_to(*motor.fit, each); };
  if (!motor.fit || std::ranges::none_of(recordings, is_fitted)) {
    return;
  }
  const auto forget = [](base::ParameterValue& parameter, const base::Range& possible) {
    // The other parameters were not identifiable in that fit and kept their own uncertainty.
    if (parameter.origin == base::Origin::measured && parameter.value > 0.0) {
      parameter.spread =
          base::Spread{base::Spread::Kind::range, std::max(parameter.value * std::exp(-2.0 * calibration::kSheet_sd), possible.low),
                       std::min(parameter.value * std::exp(2.0 * calibration::kSheet_sd), possible.high), true};
    }
  };
  for (const std::string& name : motor.fit->parameters) {
    if (base::ParameterValue* const parameter = motor::find_parameter(motor, name)) {
      forget(*parameter, calibration::possible_range(motor, name));
    }
  }
  // Parameters of effects without an interval are held.
  for (motor::MotorEffect& effect : motor.effects) {
    for (std::size_t i = 0; i < effect.parameters.size(); ++i) {
      if (effect.parameters[i].spread) {
        forget(effect.parameters[i], effect.type->parameters[i].range);
      }
    }
  }
  motor.fit.reset();
  findings.emplace_back(IntervalsOfDataSheet{});
}

}  // namespace

ModelOfLogs model_of_logs(const motor::Motor& motor, const std::vector<recording::Recording>& recordings) {
  ModelOfLogs out;
  const auto have = [&](thermal::Signal signal) {
    return std::ranges::all_of(recordings, [&](const recording::Recording& each) { return estimation::has_signal(each, signal); });
  };
  motor::Motor known = motor;
  forget_fit(known, recordings, out.findings);
  if (known.fit) {
    out.fitted = known.fit->runs;
    out.training = known.fit->training;
  }
  std::ranges::transform(recordings, std::back_inserter(out.fitted), recording::name_and_fingerprint);
  out.heat = calibration::heat_input_of(motor, recordings);
  calibration::widen(out.training, recordings, out.heat);
  if (std::optional<calibration::HeatInputLacking> lacking = calibration::lacking_heat_input(motor, recordings, {}, out.heat)) {
    out.findings.emplace_back(*std::move(lacking));
  }
  if (std::optional<calibration::ShaftPowerUnknown> unknown = calibration::shaft_power_unknown(recordings, out.heat)) {
    out.findings.emplace_back(*std::move(unknown));
  }
  calibration::MotorModel built = calibration::motor_model(known, out.heat, have(thermal::Signal::speed));
  out.how = calibration::how_to_read(motor, built.heat);
  if (calibration::is_by_current(built.heat) && !have(thermal::Signal::speed) && calibration::most_loss_at_speed_W(motor) > 0.0) {
    out.findings.emplace_back(LossInUnknownHeat{calibration::most_loss_at_speed_W(motor)});
  }
  out.model = std::move(built.model);
  out.model.columns = out.how.columns;
  if (known.fit) {
    out.usual.error_K = known.fit->free_run_error_K;
    const std::vector<double>& flux_W = known.fit->latent_flux_W;
    out.usual.flux_W = flux_W.empty() ? std::nullopt : std::optional(std::ranges::max(flux_W));
  }
  out.parameters = std::move(built.parameters);
  std::ranges::move(built.held, std::back_inserter(out.findings));
  std::ranges::move(calibration::held_in_recordings(motor, recordings), std::back_inserter(out.findings));
  std::ranges::move(estimation::columns_lacking(out.how.columns, recordings), std::back_inserter(out.findings));
  set_needed(out, motor, recordings);
  const bool has_torque = have(thermal::Signal::shaft_power);
  if (!has_torque && std::ranges::all_of(recordings, [&](const recording::Recording& each) {
        return estimation::has_signal(each, thermal::Signal::shaft_power, out.how.torque);
      })) {
    out.findings.emplace_back(TorqueFromCurrent{});
  }
  return out;
}

motor::Motor refitted_motor(const motor::Motor& motor, const ModelOfLogs& model, const Diagnosis& diagnosis) {
  motor::Motor result = motor;
  set_parameters(result, model, diagnosis.selection.own, diagnosis.runs);
  motor::refresh_values(result);
  return result;
}

motor::Motor extended_motor(const motor::Motor& motor, const ModelOfLogs& model, const Diagnosis& diagnosis) {
  motor::Motor result = motor;
  set_parameters(result, model, diagnosis.selection.after, diagnosis.runs);
  std::vector<std::string> names;
  for (const estimation::MeasuredRun& run : diagnosis.runs) {
    if (std::ranges::find(names, run.name) == names.end()) {
      names.push_back(run.name);
    }
  }
  result.sources[kSource] = fmt::format("fit to measured runs: {}", fmt::join(names, ", "));
  std::vector<motor::MotorSensor> sensors = std::move(result.sensors);
  result.sensors.clear();
  for (const FoundEffect& effect : diagnosis.effects) {
    if (!effect.name.empty()) {
      result.effects.push_back(motor_effect(effect, diagnosis.selection.after));
    } else if (const motor::SensorEffectType* type = motor::find_sensor_effect(effect.id); type && !effect.parameters.empty()) {
      sensors.push_back(motor_sensor(*type, effect.parameters.front()));
    }
  }
  for (const motor::MotorSensor& sensor : sensors) {
    add_sensor(result, sensor);
  }
  motor::refresh_values(result);
  return result;
}

std::vector<calibration::OutsideDeclaredRange> outside_declared_ranges(const motor::Motor& before, const ModelOfLogs& model,
                                                                       const motor::Motor& after) {
  std::vector<calibration::OutsideDeclaredRange> found;
  motor::Motor declared = before, fitted = after;
  for (const calibration::CalibratedValue& each : model.parameters) {
    if (!each.is_of_file) {
      continue;
    }
    const base::ParameterValue& range = *motor::find_parameter(declared, each.name);
    const double value = motor::find_parameter(fitted, each.name)->value;
    if (range.spread && range.origin != base::Origin::measured && (value < range.spread->low || value > range.spread->high)) {
      found.push_back({each.name, each.unit, value, range.spread->low, range.spread->high});
    }
  }
  return found;
}

}  // namespace heatsoak::diagnosis
