// A model that runs free through measured inputs, and how far off it is.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "identify/linearised_run.h"
#include "identify/measured_run.h"

namespace heatsoak {

/// Where a run starts; the standard deviation says how well its first samples tell.
struct RunStart {
  Eigen::VectorXd state_C;  ///< fitted
  Eigen::VectorXd prior_C;  ///< first samples
  Eigen::VectorXd prior_sd_K;
};

/// Temperatures at the start that serve best without any fit: first samples, and where a node has no sensor, what its neighbour shows.
RunStart start_of(const Network& network, const MeasuredRun& run);

/// The model along a run from start temperatures.
using RunFrom = std::function<LinearisedRun(std::span<const double> start_C, const MeasuredRun& run)>;
struct DecidedStart {
  Eigen::VectorXd state_C;
  Eigen::MatrixXd covariance_K2;
};
/// The start that the first five samples decide, or the first minute (at most a tenth of the run) where a node has no sensor, around what
/// `start` has for probable.
DecidedStart decided_start(const Network& network, const RunStart& start, const MeasuredRun& run, const RunFrom& along);
Eigen::VectorXd decided_start_C(const Network& network, const RunStart& start, const MeasuredRun& run, const RunFrom& along);

/// What the sensors would show (n × sensors) if the model ran free from the run's start. The start is decided by the first five samples
/// only, or the first minute (at most a tenth of the run) where a node has no sensor: a model that lacks heat must not hide it there.
Eigen::MatrixXd open_loop_C(const Network& network, std::span<const double> parameters, const MeasuredRun& run);

struct SignalError {
  std::string signal;
  double rmse_K = 0.0;
  double max_abs_K = 0.0;
  Eigen::Index samples = 0;
};

/// Of all that a sensor showed; how far a model that says nothing is off.
double standard_deviation_K(std::span<const MeasuredRun> runs, std::string_view signal);

}  // namespace heatsoak
