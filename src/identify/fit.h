// A model fitted to any number of runs at once, in the presence of unknown heat.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "identify/evidence.h"
#include "identify/flux_search.h"
#include "identify/measured_run.h"
#include "identify/model.h"
#include "identify/open_loop.h"

namespace heatsoak {

struct FitOptions {
  int starts = 8;             ///< Latin hypercube points besides the model's own values; 0: only those
  double start_spread = 1.1;  ///< ± of a point in θ: ln 3
  std::uint64_t seed = 1;     ///< of the points
  int threads = 0;            ///< 0: all cores; the result does not depend on it
  bool is_robust = true;      ///< outliers count less or not at all
  bool with_flux = true;      ///< false: the heat is all known, for comparison
  bool with_wander = true;    ///< false: sensors have no slow errors of their own
};

/// One supposition about what is not known, how probable it is, and what follows from it.
struct Hypothesis {
  Supposition supposition;
  double weight = 0.0;  ///< sum over all is 1
  Eigen::VectorXd theta;
  Eigen::MatrixXd covariance;
};

struct Fit {
  Eigen::VectorXd theta;
  Eigen::MatrixXd covariance;    ///< of θ, over all hypotheses
  LatentFlux flux;               ///< the most probable
  std::vector<double> wander_K;  ///< per place in sensor_nodes, the most probable; empty: no sensor wanders
  double wander_time_scale_s = 0.0;
  double usual_heat_W = 0.0;        ///< mean over the runs of what the model makes or leads away, whichever is more
  std::vector<double> noise_ratio;  ///< per place in sensor_nodes: noise that the fit finds over the model-free one
  std::vector<std::string> sensor_nodes;
  std::vector<Hypothesis> hypotheses;
  std::vector<RunStart> starts;          ///< per run
  std::vector<Eigen::VectorXd> weights;  ///< per run: of each sample, 1 unless it is an outlier
  double rejected_share = 0.0;           ///< of the samples
  double log_evidence = 0.0;             ///< at the most probable flux and the figures that are most probable with it
  int iterations = 0;
  bool has_converged = false;
  double free_run_error_K = 0.0;  ///< above 0: θ is what follows the whole runs best, to this (rms); other figures do far worse
  /// R of the whitened [∂/∂θ, residual] of all runs without the prior, at θ: what the data alone say.
  Eigen::MatrixXd data_triangle;
};

/// Maximum of the posterior in θ for the most probable flux and noise. Throws Failure (cannot_answer) where no start leads to a
/// model that can be run.
Fit fit(const Model& model, std::span<const MeasuredRun> runs, const FitOptions& options);

/// Noise of a run's sensors as a fit has it.
SensorNoise noise_of(const MeasuredRun& run, const Fit& fit, std::size_t run_index);

}  // namespace heatsoak
