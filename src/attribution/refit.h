// All runs together once more in the equations: Gauss-Newton in whitened space under one supposition about the unknown heat, bounds kept.
#pragma once

#include <limits>
#include <vector>

#include "attribution/design.h"

namespace heatsoak {

struct RefitResult {
  ExtendedModel model;
  std::vector<std::vector<double>> start_C;  ///< per run
  std::vector<LinearisedRun> fitted;         ///< free runs of the model
  LatentFlux flux;                           ///< supposed
  double evidence_nats = 0.0;
  Eigen::MatrixXd covariance;  ///< of the coordinates; 0 for those at a bound
  bool converged = false;
};

struct RefitOptions {
  LatentFlux flux;
  std::vector<Eigen::VectorXd> weights = {};  ///< per run and sample; empty: all count
  std::vector<int> merged = {};               ///< per run how many samples are averaged; empty: none
  double white_noise_K = 0.0;                 ///< above 0: of every sensor, instead of its own; for a model that lacks something
  int most_steps = 8;
  double longest_step_ratio = std::numeric_limits<double>::infinity();  ///< of a coordinate
  /// The result is averaged over these as they are probable, for intervals that hold what they promise. Empty: `flux` alone.
  std::vector<LatentFlux> around = {};
};

/// `start_C` per run, as linearise() takes it. Throws Failure (numerics_failed) where the model cannot be run at all.
RefitResult refit(ExtendedModel model, const std::vector<MeasuredRun>& runs, std::vector<std::vector<double>> start_C,
                  const RefitOptions& options);

/// The same for a model that is only tried: where its temperatures run away its evidence is −∞, and nothing of it is fitted.
RefitResult try_refit(ExtendedModel model, const std::vector<MeasuredRun>& runs, std::vector<std::vector<double>> start_C,
                      const RefitOptions& options);

}  // namespace heatsoak
