// Predicts logs with a motor file: temperatures, their 90 % band, and their errors.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibration/assumptions.h"
#include "calibration/forecast/band.h"
#include "calibration/forecast/forecast_setup.h"
#include "recording/recording.h"

namespace heatsoak::calibration {

/// Prediction of one sensor in one run; all vectors have one value per sample.
struct PredictedSignal {
  std::string signal;              ///< key, for example "winding_C"
  std::vector<double> measured_C;  ///< NaN: not measured
  std::vector<double> predicted_C;
  std::vector<double> low_C, high_C;  ///< limits of the 90 % band of the measured samples
  double rmse_K = 0.0;
  double max_abs_K = 0.0;
  double coverage_share = 0.0;  ///< share of the samples within the band
  std::size_t samples = 0;      ///< number of measured samples
};

struct PredictedRun {
  std::string name;
  std::vector<double> time_s;
  std::vector<PredictedSignal> signals;
};

/// Predictions of several runs. They are not pooled, because errors under different conditions have different distributions.
struct Prediction {
  std::vector<PredictedRun> runs;
  std::vector<PredictionNote> notes;
  std::vector<SignalsMissing> missing;  ///< effects that acted as if their signals had the default
};

/// Predicts a run from its first temperatures and measured inputs. `covariance` is that of θ.
PredictedRun predict(const ForecastModel& model, const Eigen::VectorXd& theta, const Eigen::MatrixXd& covariance,
                     const motor::ForecastBand& band, const estimation::MeasuredRun& run);

/// Reads the runs of the recordings with the signals that the setup's model needs. Appends the notes of measured_runs() to `notes`.
/// Throws Failure as measured_runs().
std::vector<estimation::MeasuredRun> forecast_runs(const ForecastSetup& setup, std::span<const recording::Recording> recordings,
                                                   std::optional<double> ambient_C, std::vector<estimation::RunNote>& notes);

struct PredictionOptions {
  std::optional<double> ambient_C = {};  ///< for logs without an ambient temperature
  std::optional<HeatInput> heat = {};    ///< heat input of the model; empty: that of the motor file's fit
};

/// Predicts each recording separately with the heat input of the model; a recording that lacks it, and a model that states none, use the
/// first one that the recording has, see heat_input_of(). Without a fit in the motor file, the parameters have their prior uncertainty.
/// Throws Failure: bad_input if a log has no heat input or no temperature, numerics_failed if the temperatures diverge.
Prediction predict(const motor::Motor& motor, std::span<const recording::Recording> recordings, const PredictionOptions& options);

/// Returns the recordings that can be predicted with all these motors. Appends the others, along which temperatures diverge, to
/// `diverging`: a log that only scores an answer must not prevent it.
std::vector<recording::Recording> predictable(std::span<const motor::Motor> motors, std::span<const recording::Recording> recordings,
                                              const PredictionOptions& options, std::vector<HoldoutDiverges>& diverging);

/// A recording, and the motor file that results from a fit without it.
struct LeftOutRecording {
  recording::Recording recording;
  std::vector<estimation::MeasuredRun> runs;  ///< its runs, in which wrong samples are NaN
  motor::Motor without;
};

/// Fits the band to the errors of predictions of recordings (at least one) that the parameters were not fitted to. Throws
/// Failure (numerics_failed) if temperatures diverge.
motor::ForecastBand band_of_left_out(std::span<const LeftOutRecording> left_out);

}  // namespace heatsoak::calibration
