// Fits the free parameters of a model to one or more runs at once, in the presence of an unknown heat flux.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "estimation/evidence.h"
#include "estimation/flux_search.h"
#include "estimation/measured_run.h"
#include "estimation/model.h"
#include "estimation/open_loop.h"

namespace heatsoak::estimation {

struct FitOptions {
  int starts = 8;             ///< Latin hypercube points in addition to the model's own values; 0: only the latter
  double start_spread = 1.1;  ///< half width of the hypercube in θ; 1.1 = ln 3
  std::uint64_t seed = 1;     ///< seeds the random hypercube points
  int threads = 0;            ///< 0: all cores; the result does not depend on it
  bool with_flux = true;      ///< false: assumes no unknown heat flux (for comparison)
};

/// One setting of the unknown heat flux and sensor drift, with its probability and the resulting fit.
struct Hypothesis {
  Supposition supposition;
  double weight = 0.0;  ///< posterior probability; the sum over all hypotheses is 1
  Eigen::VectorXd theta;
  Eigen::MatrixXd covariance;
};

struct Fit {
  Eigen::VectorXd theta;
  Eigen::MatrixXd covariance;   ///< covariance of θ, averaged over all hypotheses
  LatentFlux flux;              ///< most probable value
  std::vector<double> drift_K;  ///< most probable drift (standard deviation) per entry of sensor_nodes; empty: no sensor drifts
  double drift_time_scale_s = 0.0;
  double usual_heat_W = 0.0;        ///< mean over time of the heat that the model generates or dissipates, whichever is larger
  std::vector<double> noise_ratio;  ///< per entry of sensor_nodes: noise found by the fit divided by the model-free estimate
  std::vector<std::string> sensor_nodes;
  std::vector<Hypothesis> hypotheses;
  std::vector<RunStart> starts;          ///< per run
  std::vector<Eigen::VectorXd> weights;  ///< per run and sample (n·s): 1, less for an outlier, 0 if rejected
  double rejected_share = 0.0;           ///< fraction of the samples with weight 0
  double log_evidence = 0.0;             ///< in nats, at the most probable flux and the parameters that are most probable with it
  int iterations = 0;
  bool has_converged = false;
  std::optional<double> free_run_error_K =
      {};  ///< RMS error, if θ was taken from the free-run fit because that predicts whole runs far better
  /// Factor R of the whitened [∂/∂θ, residual] of all runs at θ, without the prior: the information in the data alone.
  Eigen::MatrixXd data_triangle;
};

/// Returns the maximum of the posterior in θ for the most probable flux and noise. Throws Failure (cannot_answer) if the simulation
/// diverges from every starting point.
Fit fit(const Model& model, std::span<const MeasuredRun> runs, const FitOptions& options);

/// Returns the noise, drift and sample weights that the fit found for the sensors of one of its runs.
SensorNoise noise_of(const MeasuredRun& run, const Fit& fit, std::size_t run_index);

}  // namespace heatsoak::estimation
