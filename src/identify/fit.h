// A model fitted to any number of runs at once, in the presence of unknown heat.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "identify/evidence.h"
#include "identify/measured_run.h"
#include "identify/model.h"

namespace heatsoak {

struct FitOptions {
  int starts = 8;             ///< Latin hypercube points besides the model's own values; 0: only those
  double start_spread = 1.1;  ///< ± of a point in θ: ln 3
  std::uint64_t seed = 1;     ///< of the points
  int threads = 0;            ///< 0: all cores; the result does not depend on it
  bool is_robust = true;      ///< outliers count less or not at all
  bool with_flux = true;      ///< false: the heat is all known, for comparison
};

/// Where a run starts; the standard deviation says how well its first samples tell.
struct RunStart {
  Eigen::VectorXd state_C;  ///< fitted
  Eigen::VectorXd prior_C;  ///< first samples
  Eigen::VectorXd prior_sd_K;
};

/// One supposition about the unknown heat, how probable it is, and what follows from it.
struct FluxHypothesis {
  LatentFlux flux;
  double weight = 0.0;  ///< sum over all is 1
  Eigen::VectorXd theta;
  Eigen::MatrixXd covariance;
};

struct Fit {
  Eigen::VectorXd theta;
  Eigen::MatrixXd covariance;       ///< of θ, over all hypotheses about the unknown heat
  LatentFlux flux;                  ///< the most probable
  std::vector<double> noise_ratio;  ///< per place in sensor_nodes: noise that the fit finds over the model-free one
  std::vector<std::string> sensor_nodes;
  std::vector<FluxHypothesis> hypotheses;
  std::vector<RunStart> starts;          ///< per run
  std::vector<Eigen::VectorXd> weights;  ///< per run: of each sample, 1 unless it is an outlier
  double rejected_share = 0.0;           ///< of the samples
  double log_evidence = 0.0;             ///< at the most probable flux
  int iterations = 0;
  bool has_converged = false;
  /// R of the whitened [∂/∂θ, residual] of all runs without the prior, at θ: what the data alone say.
  Eigen::MatrixXd data_triangle;
};

/// Maximum of the posterior in θ for the most probable flux and noise. Throws Failure (numerics_failed) where no start leads to a
/// model that can be run.
Fit fit(const Model& model, std::span<const MeasuredRun> runs, const FitOptions& options);

/// Noise of a run's sensors as a fit has it.
SensorNoise noise_of(const MeasuredRun& run, const Fit& fit, std::size_t run_index);

/// The open-loop prediction: the model run from its fitted (or, for `starts` of other runs, first measured) temperatures through the
/// measured inputs.
struct SignalError {
  std::string signal;
  double rmse_K = 0.0;
  double max_abs_K = 0.0;
  Eigen::Index samples = 0;
};

/// Temperatures at the start that serve best without any fit: first samples, and where a node has no sensor, what its neighbour shows.
RunStart start_of(const Network& network, const MeasuredRun& run);

/// What the sensors would show (n × sensors) if the model ran free from the run's start. The start is decided by the first five samples
/// only: a model that lacks heat must not hide it there.
Eigen::MatrixXd open_loop_C(const Network& network, std::span<const double> parameters, const MeasuredRun& run);

/// Errors of the free-running model over all runs, by signal.
std::vector<SignalError> open_loop_error(const Network& network, std::span<const double> parameters, std::span<const MeasuredRun> runs);

}  // namespace heatsoak
