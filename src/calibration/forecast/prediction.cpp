#include "calibration/forecast/prediction.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <string>

#include "calibration/effect_signals.h"
#include "calibration/unlogged_speed.h"
#include "estimation/log_columns.h"
#include "estimation/turning_rows.h"
#include "motor/conditions.h"
#include "motor/datasheet_network.h"

namespace heatsoak::calibration {
namespace {

PredictedSignal signal_of(const estimation::MeasuredRun& run, const estimation::LinearisedRun& path, const Eigen::VectorXd& sd_K,
                          Eigen::Index sensor) {
  PredictedSignal out;
  out.signal = run.sensors[static_cast<std::size_t>(sensor)].signal;
  double squares_K2 = 0.0;
  double within = 0.0;
  for (Eigen::Index k = 0; k < run.samples(); ++k) {
    const double sensor_C = path.sensor_C(k, sensor);
    const double measured_C = run.measured_C(k, sensor);
    const double reach_K = kBand_sd * sd_K[k * path.sensors() + sensor];
    out.measured_C.push_back(measured_C);
    out.predicted_C.push_back(sensor_C);
    out.low_C.push_back(sensor_C - reach_K);
    out.high_C.push_back(sensor_C + reach_K);
    if (!std::isnan(measured_C)) {
      const double error_K = std::abs(measured_C - sensor_C);
      squares_K2 += error_K * error_K;
      out.max_abs_K = std::max(out.max_abs_K, error_K);
      within += error_K <= reach_K ? 1.0 : 0.0;
      ++out.samples;
    }
  }
  if (out.samples > 0) {
    out.rmse_K = std::sqrt(squares_K2 / static_cast<double>(out.samples));
    out.coverage_share = within / static_cast<double>(out.samples);
  }
  return out;
}

double longest_s(std::span<const estimation::MeasuredRun> runs) {
  double longest_s = 0.0;
  for (const estimation::MeasuredRun& run : runs) {
    longest_s = std::max(longest_s, run.time_s.back() - run.time_s.front());
  }
  return longest_s;
}

/// Returns the motor under the conditions that a recording states. The recording's name is its condition "run".
motor::Motor as_in(const recording::Recording& recording, const motor::Motor& motor) {
  std::map<std::string, std::string> stated = recording.conditions;
  stated.emplace("run", recording.name);
  std::map<std::string, std::string> of_motor;
  for (const motor::MotorEffect& effect : motor.effects) {
    for (const auto& [key, value] : effect.condition) {
      if (const auto found = stated.find(key); found != stated.end()) {
        of_motor.insert(*found);
      }
    }
  }
  return of_motor.empty() ? motor : motor::under(motor, of_motor);
}

struct FileModel {
  ForecastModel model;
  Eigen::MatrixXd covariance;  ///< the covariance of θ
  double unseen_loss_W = 0.0;  ///< largest loss at a speed that the runs do not contain; 0: none
};

/// Returns the model of a motor file for runs with the heat input of `setup`.
FileModel model_of_file(ForecastSetup setup, const motor::Motor& motor, std::span<const estimation::MeasuredRun> runs) {
  double unseen_loss_W = is_by_current(setup.heat) ? most_loss_at_speed_W(motor) : 0.0;
  if (unseen_loss_W > 0.0 && std::ranges::any_of(runs, turns_unseen)) {
    setup.opens_loss_at_speed = true;
  } else {
    unseen_loss_W = 0.0;
  }
  ForecastModel model = setup.model();
  const Eigen::MatrixXd& precision = model.prior().precision;
  Eigen::MatrixXd covariance = precision.ldlt().solve(Eigen::MatrixXd::Identity(precision.rows(), precision.cols()));
  return {std::move(model), std::move(covariance), unseen_loss_W};
}

void predict_one(const motor::Motor& motor, const recording::Recording& recording, const PredictionOptions& options, Prediction& all) {
  const std::span<const recording::Recording> own(&recording, 1);
  ForecastSetup setup = forecast_setup(motor, own, options.heat);
  if (std::optional<HeatInputLacking> lacking = lacking_heat_input(motor, own, {options.heat, true}, setup.heat)) {
    all.notes.emplace_back(*std::move(lacking));
  }
  std::vector<estimation::RunNote> notes;
  std::vector<estimation::MeasuredRun> runs = forecast_runs(setup, own, options.ambient_C, notes);
  std::ranges::move(notes, std::back_inserter(all.notes));
  for (SignalsMissing& each : missing_signals(motor, own, how_to_read(motor, setup.heat))) {
    each.recording = recording.name;
    all.missing.push_back(std::move(each));
  }
  if (motor.fit && motor.fit->is_speed_linear) {
    runs = estimation::turning_within_rows(std::move(runs));
  }
  const FileModel file = model_of_file(std::move(setup), motor, runs);
  if (file.unseen_loss_W > 0.0) {
    all.notes.emplace_back(BandIncludesLossAtSpeed{recording.name, file.unseen_loss_W});
  }
  const motor::ForecastBand band = motor.fit && motor.fit->band ? *motor.fit->band : usual_band(longest_s(runs));
  for (const estimation::MeasuredRun& run : runs) {
    all.runs.push_back(predict(file.model, file.model.start(), file.covariance, band, run));
  }
}

}  // namespace

PredictedRun predict(const ForecastModel& model, const Eigen::VectorXd& theta, const Eigen::MatrixXd& covariance,
                     const motor::ForecastBand& band, const estimation::MeasuredRun& run) {
  estimation::DecidedStart start = model.decided_start(run, theta);
  const estimation::LinearisedRun path =
      model.along(run, theta, 0.0, {start.state_C.data(), static_cast<std::size_t>(start.state_C.size())});
  const double heat_W = rms_heat_W(model.network(), model.values_in(run, theta, 0.0), run, path.state_C);
  const Eigen::VectorXd sd_K = forecast_sd_K(path, run, covariance, start.covariance_K2, heat_W, band);
  PredictedRun out{run.name, run.time_s, {}};
  for (Eigen::Index sensor = 0; sensor < path.sensors(); ++sensor) {
    out.signals.push_back(signal_of(run, path, sd_K, sensor));
  }
  return out;
}

std::vector<estimation::MeasuredRun> forecast_runs(const ForecastSetup& setup, std::span<const recording::Recording> recordings,
                                                   std::optional<double> ambient_C, std::vector<estimation::RunNote>& notes) {
  estimation::MeasuredRunOptions how = how_to_read(setup.motor, setup.heat);
  how.needed = setup.model().motor().needed;
  how.ambient_C = ambient_C;
  std::vector<estimation::MeasuredRun> all;
  for (const recording::Recording& recording : recordings) {
    estimation::MeasuredRunOptions here = how;
    // If a log has a speed column, only rows with a speed are used.
    std::erase(here.needed, thermal::Signal::speed);
    if (setup.heat != HeatInput::input_power && estimation::has_signal(recording, thermal::Signal::speed)) {
      here.needed.push_back(thermal::Signal::speed);
    }
    need_signals_of_effects(setup.motor, recording, here);
    estimation::MeasuredRuns found = estimation::measured_runs(recording, here);
    std::ranges::move(found.runs, std::back_inserter(all));
    std::ranges::move(found.notes, std::back_inserter(notes));
  }
  return all;
}

std::vector<recording::Recording> predictable(std::span<const motor::Motor> motors, std::span<const recording::Recording> recordings,
                                              const PredictionOptions& options, std::vector<HoldoutDiverges>& diverging) {
  std::vector<recording::Recording> all;
  for (const recording::Recording& recording : recordings) {
    try {
      for (const motor::Motor& motor : motors) {
        predict(motor, {&recording, 1}, options);
      }
      all.push_back(recording);
    } catch (const estimation::RunNotSimulated&) {
      diverging.push_back({recording.name});
    }
  }
  return all;
}

motor::ForecastBand band_of_left_out(std::span<const LeftOutRecording> left_out) {
  std::vector<estimation::MeasuredRun> runs;
  std::vector<PredictedPiece> pieces;
  for (const LeftOutRecording& each : left_out) {
    const motor::Motor motor = as_in(each.recording, each.without);
    FileModel file = model_of_file(forecast_setup(motor, {&each.recording, 1}), motor, each.runs);
    for (const estimation::MeasuredRun& run : each.runs) {
      pieces.push_back(predicted_run(file.model, file.model.start(), file.covariance, run, runs.size()));
      runs.push_back(run);
    }
  }
  return fit_band(runs, pieces);
}

Prediction predict(const motor::Motor& motor, std::span<const recording::Recording> recordings, const PredictionOptions& options) {
  Prediction all;
  std::ranges::move(estimation::columns_lacking(how_to_read(motor, HeatInput::current).columns, recordings), std::back_inserter(all.notes));
  for (const recording::Recording& recording : recordings) {
    predict_one(as_in(recording, motor), recording, options, all);
  }
  if (!motor.fit || !motor.fit->band) {
    all.notes.emplace_back(BandIsEstimated{motor.id});
  }
  return all;
}

}  // namespace heatsoak::calibration
