// A motor's file run along logs that it was not fitted to: predicted temperatures, their 90 % band, and how far off they were.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "identify/forecast/band.h"
#include "identify/forecast/forecast_setup.h"
#include "identify/measurement/recording.h"

namespace heatsoak {

/// One sensor in one run; all vectors have one value per sample.
struct PredictedSignal {
  std::string signal;              ///< "winding_C"
  std::vector<double> measured_C;  ///< NaN: nothing measured
  std::vector<double> predicted_C;
  std::vector<double> low_C, high_C;  ///< 90 % of the measured samples are expected between them
  double rmse_K = 0.0;
  double max_abs_K = 0.0;
  double coverage_share = 0.0;  ///< share of the samples within the band
  std::size_t samples = 0;      ///< that were measured
};

struct PredictedRun {
  std::string name;
  std::vector<double> time_s;
  std::vector<PredictedSignal> signals;
};

/// Runs stay apart: errors under different conditions are no sample of one distribution.
struct Prediction {
  std::vector<PredictedRun> runs;
  std::vector<std::string> notes;  ///< what was taken for granted, in sentences
};

/// The run from its first temperatures under measured inputs. `covariance`: of θ.
PredictedRun predict(const ForecastModel& model, const Eigen::VectorXd& theta, const Eigen::MatrixXd& covariance, const ForecastBand& band,
                     const MeasuredRun& run);

/// Runs of recordings as the setup's model takes them; notes of the reader are added. Throws Failure as measured_runs().
std::vector<MeasuredRun> forecast_runs(const ForecastSetup& setup, std::span<const Recording> recordings, double ambient_C,
                                       std::vector<std::string>& notes);

struct PredictionOptions {
  double ambient_C = MeasuredRunOptions::kNotStated_C;  ///< where a log has none
  bool turns_within_rows = false;                       ///< a speed that changes its sign from row to row went straight in between
};

/// Each recording by itself, under whatever heat input it has: the power balance, a current, a torque, or input power. Of a motor without
/// a fit the parameters are as uncertain as its data sheet. Throws Failure (bad_input) where a log has
/// no heat input or no temperature, numerics_failed where the temperatures run away.
Prediction predict(const Motor& motor, std::span<const Recording> recordings, const PredictionOptions& options);

}  // namespace heatsoak
