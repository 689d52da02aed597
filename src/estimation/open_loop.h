// Free-running (open-loop) simulation with measured inputs, its start temperatures and its error.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "estimation/linearised_run.h"
#include "estimation/measured_run.h"

namespace heatsoak::estimation {

/// Start temperatures of a run, per state node. prior_sd_K states how well the first samples determine them.
struct RunStart {
  Eigen::VectorXd state_C;  ///< fitted start
  Eigen::VectorXd prior_C;  ///< from the first samples
  Eigen::VectorXd prior_sd_K;
};

/// Estimates the start temperatures without a fit: the first sample of each sensor; for winding and stator without a sensor the mean of the
/// sensors, also for bodies of effects. If the winding has a sensor, these bodies are in the middle between that mean and ambient. Without
/// sensors everything is at ambient temperature.
RunStart start_of(const thermal::Network& network, const MeasuredRun& run);

/// Simulates and linearises the model along a run from given start temperatures.
using RunFrom = std::function<LinearisedRun(std::span<const double> start_C, const MeasuredRun& run)>;
struct DecidedStart {
  Eigen::VectorXd state_C;
  Eigen::MatrixXd covariance_K2;
};
/// Estimates the start temperatures from the first five samples, or from the first minute (at most a tenth of the run) if a node has no
/// sensor. The prior is that of `start`. Readings have independent errors: the noise of their sensor, at least 0.3 K. If the winding has a
/// sensor and the model a body of an effect, two errors of the model are added: the misfit beyond the noise, which is correlated in time,
/// and a factor of 1 ± 0.1 on the predicted change of each reading.
DecidedStart decided_start(const thermal::Network& network, const RunStart& start, const MeasuredRun& run, const RunFrom& along);
/// Returns the temperatures of decided_start() in °C.
Eigen::VectorXd decided_start_C(const thermal::Network& network, const RunStart& start, const MeasuredRun& run, const RunFrom& along);

/// Returns the predicted readings (n × sensors, in °C) of a free-running simulation. The start temperatures come from decided_start(), that
/// is, only from the first samples: otherwise they could compensate for heat that the model lacks.
Eigen::MatrixXd open_loop_C(const thermal::Network& network, std::span<const double> parameters, const MeasuredRun& run);

/// Error of a predicted signal.
struct SignalError {
  std::string signal;
  double rmse_K = 0.0;
  double max_abs_K = 0.0;
  Eigen::Index samples = 0;
};

/// Standard deviation of all readings of a sensor in all runs. It is the RMS error of a constant prediction.
double standard_deviation_K(std::span<const MeasuredRun> runs, std::string_view signal);

}  // namespace heatsoak::estimation
