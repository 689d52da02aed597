#include "calibration/calibrate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "base/collected_failures.h"
#include "base/diagnostic.h"
#include "base/parallel.h"
#include "calibration/contradicting_run.h"
#include "calibration/effect_signals.h"
#include "calibration/identifiability.h"
#include "calibration/profile.h"
#include "calibration/terminal_resistance.h"
#include "calibration/training_range.h"
#include "calibration/unlogged_speed.h"
#include "calibration/written_forecast.h"
#include "estimation/interval.h"
#include "estimation/log_columns.h"
#include "estimation/thresholds.h"
#include "estimation/turning_rows.h"
#include "motor/write_motor.h"
#include "recording/fingerprint.h"
#include "recording/quality.h"

namespace heatsoak::calibration {
namespace {

/// Largest standard deviation of a logarithm for which the curvature at the optimum describes the likelihood well.
constexpr double kCurvatureHolds_sd = 0.1;

/// Reads the runs of all recordings. If the heat follows from the current, a log with a speed column needs a speed in every row; a log
/// without that column is accepted. Throws the failures of all recordings.
std::vector<estimation::MeasuredRun> runs_of(const ForecastSetup& setup, std::span<const recording::Recording> recordings,
                                             const estimation::MeasuredRunOptions& options, std::vector<estimation::RunNote>& notes) {
  std::vector<estimation::MeasuredRun> all;
  base::CollectedFailures failures;
  for (const recording::Recording& recording : recordings) {
    estimation::MeasuredRunOptions here = options;
    const auto needs = [&](thermal::Signal signal) { return std::ranges::find(here.needed, signal) != here.needed.end(); };
    if (needs(thermal::Signal::current) && estimation::has_signal(recording, thermal::Signal::speed) && !needs(thermal::Signal::speed)) {
      here.needed.push_back(thermal::Signal::speed);
    } else if (!estimation::has_signal(recording, thermal::Signal::speed)) {
      std::erase(here.needed, thermal::Signal::speed);
    }
    need_signals_of_effects(setup.motor, recording, here);
    if (std::optional<estimation::MeasuredRuns> found = failures.attempt([&] { return estimation::measured_runs(recording, here); })) {
      std::ranges::move(found->runs, std::back_inserter(all));
      std::ranges::move(found->notes, std::back_inserter(notes));
    }
  }
  failures.throw_if_any();
  return all;
}

class Calibrating {
 public:
  Calibrating(std::span<const recording::Recording> recordings, std::span<const recording::Recording> holdout,
              const CalibrationOptions& options)
      : recordings_(recordings), holdout_(holdout), options_(options) {}

  Calibration run(const motor::Motor& motor) {
    setup_ = forecast_setup(motor, recordings_);
    all_.effects = setup_.motor.effects;
    all_.motor_model = motor_model(setup_.motor, setup_.heat, setup_.has_speed);
    const double most_loss_W = is_by_current(setup_.heat) ? most_loss_at_speed_W(motor) : 0.0;
    if (std::optional<HeatInputLacking> lacking = lacking_heat_input(motor, recordings_, {}, setup_.heat)) {
      all_.findings.emplace_back(*std::move(lacking));
    }
    if (std::optional<ShaftPowerUnknown> unknown = shaft_power_unknown(recordings_, setup_.heat)) {
      all_.findings.emplace_back(*std::move(unknown));
    }
    std::ranges::copy(all_.motor_model.held, std::back_inserter(all_.findings));
    std::ranges::move(held_in_recordings(motor, recordings_), std::back_inserter(all_.findings));
    estimation::MeasuredRunOptions how = how_to_read(motor, setup_.heat);
    std::ranges::move(estimation::columns_lacking(how.columns, recordings_), std::back_inserter(all_.findings));
    std::ranges::move(missing_signals(motor, recordings_, how), std::back_inserter(all_.findings));
    how.needed = all_.motor_model.needed;
    how.ambient_C = options_.ambient_C;
    std::vector<estimation::RunNote> notes;
    all_.runs = runs_of(setup_, recordings_, how, notes);
    std::ranges::move(notes, std::back_inserter(all_.findings));
    std::ranges::transform(recordings_, std::back_inserter(all_.fitted), recording::name_and_fingerprint);
    all_.training = motor.fit ? motor.fit->training : motor::TrainingRange{};
    widen(all_.training, recordings_, setup_.heat);
    if (most_loss_W > 0.0 && std::ranges::any_of(all_.runs, turns_unseen)) {
      open_loss_at_speed(all_.motor_model, motor);
      setup_.opens_loss_at_speed = true;
      all_.findings.push_back(LossAtSpeedUnknown{most_loss_W});
    }
    options_.progress.expect(calibration_work(all_.runs, options_.fit.threads));
    options_.progress.begin(calibration_phases::kFitting);
    all_.fit = estimation::fit(all_.motor_model.model, all_.runs, options_.fit);
    settle_speed(motor.fit && motor.fit->is_speed_linear);
    options_.progress.begin(calibration_phases::kIntervals);
    warn();
    widen_by_rows();
    parameters();
    is_learned_ = std::ranges::any_of(all_.parameters, [](const auto& each) { return each.is_learned || each.is_identifiable; });
    all_.open = open_directions(all_.motor_model, all_.fit, all_.runs, all_.parameters);
    all_.next_experiment = next_experiment(all_.open);
    forecast();
    report_large_changes();
    errors();
    refuse_where_nothing_is_explained();
    report_outside_declared_ranges(motor);
    report_common_factor();
    if (const std::optional<ResistanceDiffers> other = other_terminal_resistance(motor, recordings_)) {
      all_.findings.emplace_back(*other);
    }
    report_grown_errors(false, pooled_error_);
    refuse_where_nothing_was_learned();
    report_poor_fit();
    report_contradicting_run();
    score_holdout(motor);
    return std::move(all_);
  }

 private:
  /// Decides how the speed varies within rows in which the motor may reverse, and refits if necessary. `of_file`: as the file states.
  void settle_speed(bool of_file) {
    runs_as_in_file_ = of_file ? estimation::turning_within_rows(all_.runs) : all_.runs;
    estimation::Model near = all_.motor_model.model;
    near.values = near.values_at(all_.fit.theta);
    std::optional<bool> is_linear;
    base::in_parallel(1, options_.fit.threads, [&](std::size_t) { is_linear = estimation::settle_turning_rows(near, all_.runs); });
    all_.is_speed_linear = is_linear.value_or(of_file);
    if (is_linear.value_or(false)) {
      estimation::FitOptions from_near = options_.fit;
      from_near.starts = 0;
      all_.fit = estimation::fit(near, all_.runs, from_near);
      all_.findings.push_back(RowsTurn{});
    }
  }

  /// Runs the forecast fit to whole runs, and writes its parameters if they predict better.
  void forecast() {
    const ForecastModel base = setup_.model();
    all_.forecast =
        forecast_of(setup_, all_.runs, std::vector{base.within_bounds(all_.fit.theta)}, options_.fit.threads, options_.progress);
    score_innovations(setup_.model(), options_.fit, all_, options_.progress.begin(calibration_phases::kLeavingOut));
    options_.progress.begin(calibration_phases::kPredicting);
    const std::vector<PredictedRun> by_innovations = fitted_runs(base, base.within_bounds(all_.fit.theta), all_.runs);
    innovations_error_ = errors_over_runs(by_innovations, by_innovations);
    const bool is_better_fit =
        rms_error_K(fitted_runs(all_.forecast->model(), all_.forecast->fit.theta, all_.runs)) < rms_error_K(by_innovations);
    if (writes_forecast(options_.written, *all_.forecast, is_better_fit)) {
      write_forecast(all_);
      all_.effects = all_.forecast->setup.motor.effects;
      widen_by_rows();
      // The forecast fit assumes no unknown heat; parameters that are not identifiable beside such heat stay so.
      const std::vector<CalibratedParameter> before = std::exchange(all_.parameters, {});
      parameters();
      carry_identifiability(*all_.forecast, before, all_.parameters);
    }
    std::ranges::move(forecast_findings(all_), std::back_inserter(all_.findings));
  }

  /// Predicts fitted runs. Their bands are not valid.
  [[nodiscard]] std::vector<PredictedRun> fitted_runs(const ForecastModel& model, const Eigen::VectorXd& theta,
                                                      const std::vector<estimation::MeasuredRun>& runs) const {
    std::vector<PredictedRun> all;
    for (const estimation::MeasuredRun& run : runs) {
      all.push_back(predict(model, theta, Eigen::MatrixXd::Zero(model.count(), model.count()), all_.forecast->band, run));
    }
    return all;
  }

  /// Computes the errors of the original and of the written file in the fitted runs.
  void errors() {
    const ForecastModel base = setup_.model();
    all_.fitted_before = fitted_runs(base, base.start(), runs_as_in_file_);
    all_.fitted_after = all_.is_forecast_written ? fitted_runs(all_.forecast->model(), all_.forecast->fit.theta, all_.runs)
                                                 : fitted_runs(base, all_.fit.theta, all_.runs);
    all_.fit_error = worst_errors(all_.fitted_before, all_.fitted_after);
    pooled_error_ = errors_over_runs(all_.fitted_before, all_.fitted_after);
  }

  /// Predicts the hold-out runs. The calibration does not depend on the result.
  void score_holdout(const motor::Motor& motor) {
    if (holdout_.empty()) {
      return;
    }
    const PredictionOptions how{options_.ambient_C, setup_.heat};
    const std::array motors{motor, calibrated_motor(motor, all_)};
    std::vector<HoldoutDiverges> diverging;
    const std::vector<recording::Recording> holdout = predictable(motors, holdout_, how, diverging);
    std::ranges::move(diverging, std::back_inserter(all_.findings));
    all_.holdout_before = predict(motors[0], holdout, how).runs;
    Prediction after = predict(motors[1], holdout, how);
    for (const PredictionNote& note : after.notes) {
      std::visit([this](const auto& each) { all_.findings.emplace_back(each); }, note);
    }
    all_.holdout_after = std::move(after.runs);
    all_.holdout_error = worst_errors(all_.holdout_before, all_.holdout_after);
    report_grown_errors(true, all_.holdout_error);
  }

  void warn() {
    const estimation::Fit& fit = all_.fit;
    // Unknown heat that is certain to exist is reported elsewhere.
    double most_W = 0.0;
    const std::vector<double>& certain_W = all_.motor_model.model.least_flux_W;
    for (std::size_t i = 0; i < fit.flux.rms_W.size(); ++i) {
      most_W = certain_W.empty() || certain_W[i] == 0.0 ? std::max(most_W, fit.flux.rms_W[i]) : most_W;
    }
    if (const double share = most_W / fit.setup.mean_heat_W; share > estimation::thresholds().material_share) {
      all_.findings.push_back(UnmodelledHeat{share, fit.setup.mean_heat_W, fit.is_flux_limited});
    }
    if (fit.flux.drift_K > 0.0) {
      all_.findings.push_back(SensorDrift{fit.flux.drift_K, fit.flux.drift_time_scale_s});
    }
    if (std::ranges::none_of(all_.runs, [](const estimation::MeasuredRun& run) { return run.sensor_at("winding").has_value(); })) {
      all_.findings.push_back(WindingNotMeasured{});
    }
    if (fit.free_run_error_K) {
      all_.findings.push_back(ResponseNeedsOtherValues{});
    }
    if (!fit.has_converged) {
      all_.findings.push_back(FitStoppedEarly{});
    }
  }

  /// Adds the uncertainty from load changes within a row (length h): they make τ_w appear smaller by a fraction of up to h²/(12·τ_w²).
  void widen_by_rows() {
    double time_s = 0.0;
    double cubes_s3 = 0.0;
    for (const estimation::MeasuredRun& run : all_.runs) {
      for (std::size_t k = 0; k + 1 < run.time_s.size(); ++k) {
        const double step_s = run.time_s[k + 1] - run.time_s[k];
        time_s += step_s;
        cubes_s3 += step_s * step_s * step_s;
      }
    }
    const Eigen::VectorXd& capacity =
        std::ranges::find(all_.motor_model.parameters, "winding_heat_capacity", &CalibratedValue::name)->exponents;
    const auto& constant = *std::ranges::find(all_.motor_model.parameters, "thermal_time_constant_winding", &CalibratedValue::name);
    const double winding_s = constant.before * std::exp(constant.exponents.dot(all_.fit.theta - all_.motor_model.model.theta()));
    const double sd_share = cubes_s3 / time_s / (12.0 * winding_s * winding_s);
    all_.fit.covariance += sd_share * sd_share * capacity * capacity.transpose();
  }

  /// Adds a note if all parameters moved by one common factor, which is the effect of wrong heat: it changes no temperature.
  void report_common_factor() {
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (const auto& [name, sign] :
         {std::pair("winding_heat_capacity", 1.0), std::pair("stator_heat_capacity", 1.0),
          std::pair("thermal_resistance_winding_stator", -1.0), std::pair("thermal_resistance_stator_ambient", -1.0)}) {
      const auto found = std::ranges::find(all_.parameters, name, &CalibratedParameter::name);
      const double moved = sign * std::log(found->value / found->before);
      least = std::min(least, moved);
      most = std::max(most, moved);
    }
    // Clearly more than the prior makes plausible.
    const auto across = std::ranges::find(all_.motor_model.parameters, "thermal_resistance_winding_stator", &CalibratedValue::name);
    const double plain = std::max(0.22, 1.5 * across->prior_sd);
    if (least > plain || most < -plain) {
      const bool is_much = least > 0.0;
      all_.findings.push_back(HeatSeemsWrong{std::exp(is_much ? least : -most), is_much});
    }
  }

  /// Lists signals that are predicted worse than before: with an incomplete model, parameters of the fast response may do that.
  void report_grown_errors(bool is_holdout, const std::vector<ErrorBeforeAfter>& errors) {
    for (const ErrorBeforeAfter& each : errors) {
      constexpr double kWorse_ratio = 1.1;
      constexpr double kLeast_K = 0.1;
      if (each.after.rmse_K > kWorse_ratio * each.before.rmse_K + kLeast_K) {
        const bool is_extended = all_.is_forecast_written && !all_.forecast->accepted.empty();
        all_.worse.push_back({each.signal, is_holdout, each.after.rmse_K, each.before.rmse_K, is_extended});
      }
    }
  }

  /// Replaces a large change of the same parameter: one warning per parameter.
  void report_outside_declared_ranges(const motor::Motor& motor) {
    for (OutsideDeclaredRange& outside : outside_declared_ranges(motor, all_.parameters)) {
      std::erase_if(all_.findings, [&](const CalibrationFinding& each) {
        const auto* const change = std::get_if<LargeChange>(&each);
        return change != nullptr && change->parameter == outside.parameter;
      });
      all_.findings.emplace_back(std::move(outside));
    }
  }

  void report_large_changes() {
    constexpr double kUnlikely_sd = 3.0;
    for (const CalibratedValue& each : all_.motor_model.parameters) {
      const double moved = each.exponents.dot(all_.fit.theta - all_.motor_model.model.theta());
      const double sd = std::sqrt(each.exponents.dot(all_.fit.covariance * each.exponents));
      const auto is_in = [&](const AcceptedExtension& added) { return each.name.starts_with(fmt::format("effects.{}.", added.name)); };
      const bool is_new = all_.forecast && std::ranges::any_of(all_.forecast->accepted, is_in);
      if (each.is_of_file && !is_new && std::abs(moved) > kUnlikely_sd * std::hypot(each.prior_sd, sd)) {
        all_.findings.push_back(LargeChange{each.name, std::exp(moved), std::abs(moved) / each.prior_sd});
      }
    }
  }

  void parameters() {
    const MotorModel& motor = all_.motor_model;
    const estimation::Model& model = motor.model;
    const estimation::Fit& fit = all_.fit;
    std::vector<std::optional<std::pair<double, double>>> profiles(static_cast<std::size_t>(model.free_count()));
    Eigen::Index of_file = 0;
    for (const CalibratedValue& each : motor.parameters) {
      of_file += each.is_of_file ? 1 : 0;
      const double moved = each.exponents.dot(fit.theta - model.theta());
      const double sd = std::sqrt(each.exponents.dot(fit.covariance * each.exponents));
      CalibratedParameter parameter{.name = each.name, .unit = each.unit, .is_of_file = each.is_of_file, .before = each.before};
      parameter.value = each.before * std::exp(moved);
      double below = estimation::kInterval_sd * sd;
      double above = estimation::kInterval_sd * sd;
      Eigen::Index only = 0;
      if (!fit.free_run_error_K && sd > kCurvatureHolds_sd && each.exponents.cwiseAbs().maxCoeff(&only) == 1.0 &&
          each.exponents.cwiseAbs().sum() == 1.0) {
        const auto [low, high] = profile_interval(model, all_.runs, fit, static_cast<int>(only));
        // The profile keeps the flux fixed; widen it for the uncertainty of the flux by the same factor as the curvature.
        const double widened = sd / std::max(1e-9, std::sqrt(fit.covariance_at_flux(only, only)));
        below = (fit.theta[only] - low) * std::max(1.0, widened);
        above = (high - fit.theta[only]) * std::max(1.0, widened);
        parameter.by_profile = true;
      }
      parameter.low = parameter.value * std::exp(-below);
      parameter.high = parameter.value * std::exp(above);
      // Without heat in the runs, values in watts are those of the file, however well the data determine the time constants.
      const bool has_watts = each.origin == base::Origin::measured || !depends_on_heat(motor, each) || is_heated(motor, all_.runs);
      const double widest_sd = std::max({sd, below / estimation::kInterval_sd, above / estimation::kInterval_sd});
      parameter.is_learned = has_watts && is_learned(widest_sd, each);
      parameter.is_identifiable = has_watts && is_identifiable(widest_sd, each);
      all_.parameters.push_back(std::move(parameter));
    }
    Eigen::MatrixXd exponents(of_file, model.free_count());
    for (Eigen::Index i = 0; i < of_file; ++i) {
      exponents.row(i) = motor.parameters[static_cast<std::size_t>(i)].exponents.transpose();
    }
    const Eigen::MatrixXd covariance = exponents * fit.covariance * exponents.transpose();
    const Eigen::VectorXd inverse_sd = covariance.diagonal().cwiseSqrt().cwiseInverse();
    all_.correlation = inverse_sd.asDiagonal() * covariance * inverse_sd.asDiagonal();
  }

  /// The innovations fit decides: the forecast fit has wider intervals.
  void refuse_where_nothing_was_learned() const {
    const bool is_file_kept = all_.is_forecast_written && all_.forecast->source == ForecastSource::file;
    if (is_file_kept || is_learned_) {
      return;
    }
    throw NothingLearned(all_.open, std::ranges::any_of(recordings_, [](const recording::Recording& each) {
                           return recording::most_direct_heat_input(each) != nullptr;
                         }));
  }

  /// Refuses if neither fit follows the runs. A model with values that its file excludes must follow more closely.
  void refuse_where_nothing_is_explained() const {
    const auto lost = [&](std::span<const ErrorBeforeAfter> errors) {
      std::map<std::string, double> rmse_K;
      std::ranges::for_each(errors, [&](const ErrorBeforeAfter& each) { rmse_K[each.signal] = each.after.rmse_K; });
      return not_followed(rmse_K, all_.runs, has_finding<LargeChange>(all_.findings) ? 0.0 : kFar_share);
    };
    if (std::vector<PoorFit> signals = lost(pooled_error_); !signals.empty() && !lost(innovations_error_).empty()) {
      throw NothingFollows(NothingFollows::Tried::parameters, std::move(signals), all_.motor_model.nuisances.empty());
    }
  }

  void report_poor_fit() {
    constexpr double kFar_K = 15.0;
    constexpr double kFar_share = 0.2;
    for (const ErrorBeforeAfter& each : pooled_error_) {
      const double moves_K = estimation::standard_deviation_K(all_.runs, each.signal);
      if (each.after.rmse_K > std::max(kFar_K, kFar_share * moves_K)) {
        all_.findings.push_back(PoorFit{each.signal, each.after.rmse_K, moves_K});
      }
    }
  }

  void report_contradicting_run() {
    base::in_parallel(1, options_.fit.threads, [&](std::size_t) {
      if (const std::optional<ContradictingRun> odd = contradicting_run(all_.motor_model.model, all_.fit, all_.runs)) {
        all_.findings.emplace_back(*odd);
      }
    });
  }

  std::span<const recording::Recording> recordings_;
  std::span<const recording::Recording> holdout_;
  const CalibrationOptions& options_;
  ForecastSetup setup_;
  std::vector<ErrorBeforeAfter> pooled_error_;            ///< over all fitted runs; decides whether the model follows them
  std::vector<ErrorBeforeAfter> innovations_error_;       ///< errors of the innovations fit in the fitted runs
  std::vector<estimation::MeasuredRun> runs_as_in_file_;  ///< speed within rows as the motor file states
  bool is_learned_ = false;                               ///< the innovations fit determined or narrowed at least one parameter
  Calibration all_;
};

std::vector<std::string> names_of(std::span<const estimation::MeasuredRun> runs) {
  std::vector<std::string> names;
  for (const estimation::MeasuredRun& run : runs) {
    const std::string name = run.name.substr(0, run.name.find('#'));
    if (std::ranges::find(names, name) == names.end()) {
      names.push_back(name);
    }
  }
  return names;
}

}  // namespace

Calibration calibrate(const motor::Motor& motor, std::span<const recording::Recording> recordings,
                      std::span<const recording::Recording> holdout, const CalibrationOptions& options) {
  return Calibrating(recordings, holdout, options).run(motor);
}

motor::Motor calibrated_motor(const motor::Motor& motor, const Calibration& calibration) {
  const std::string kSource(motor::kCalibrationSource);
  motor::Motor result = motor;
  const std::vector<std::string> extensions = add_extensions(calibration, kSource, result);
  motor::MotorFit& fit = result.fit.emplace();
  fit.motor = motor.id;
  fit.runs = motor.fit ? motor.fit->runs : std::vector<std::string>{};
  std::ranges::copy(calibration.fitted, std::back_inserter(fit.runs));
  fit.heat_input = calibration.motor_model.heat;
  fit.is_speed_linear = calibration.is_speed_linear;
  fit.training = calibration.training;
  fit.extensions = motor.fit ? motor.fit->extensions : std::vector<std::string>{};
  fit.extensions.insert(fit.extensions.end(), extensions.begin(), extensions.end());
  result.sources[kSource] = fmt::format("fit to measured runs: {}", fmt::join(names_of(calibration.runs), ", "));
  for (const CalibratedParameter& each : calibration.parameters) {
    if (!each.is_of_file) {
      continue;
    }
    fit.parameters.push_back(each.name);
    base::ParameterValue* const parameter = motor::find_parameter(result, each.name);
    parameter->value = each.value;
    parameter->printed.clear();
    if (each.is_identifiable) {
      parameter->origin = base::Origin::measured;
      parameter->source = kSource;
      parameter->derivation = "fit to measured temperatures";
    } else {
      // The value changed together with the others, but its origin is still the earlier one.
      parameter->source = motor::joined_sources(parameter->source, kSource);
      parameter->derivation +=
          fmt::format("{}fit to measured temperatures, which do not determine it alone", parameter->derivation.empty() ? "" : "; ");
    }
    const base::Range declared = possible_range(result, each.name);
    parameter->spread = base::Spread{base::Spread::Kind::range, std::max(each.low, declared.low), std::min(each.high, declared.high), true};
  }
  fit.correlation = motor::Correlation(std::span(calibration.correlation.data(), static_cast<std::size_t>(calibration.correlation.size())));
  fit.latent_flux_W = calibration.fit.flux.rms_W;
  fit.free_run_error_K = calibration.fit.free_run_error_K;
  fit.latent_flux_time_scale_s = calibration.fit.flux.time_scale_s;
  for (const CalibrationFinding& each : calibration.findings) {
    if (const auto* unmodelled = std::get_if<UnmodelledHeat>(&each)) {
      fit.unmodelled_heat_share = unmodelled->share;
    }
  }
  for (const estimation::MeasuredRun& run : calibration.runs) {
    for (const estimation::Sensor& sensor : run.sensors) {
      if (std::ranges::find(fit.noise_K, sensor.node, [](const auto& each) { return each.first; }) == fit.noise_K.end()) {
        fit.noise_K.emplace_back(sensor.node, sensor.noise_K);
      }
    }
  }
  fit.band = motor::rounded_as_in_file(calibration.forecast->band);
  motor::refresh_values(result);
  return result;
}

}  // namespace heatsoak::calibration
