// Nonlinear fit of all runs together: Gauss-Newton on whitened residuals for one assumed unknown heat, with bounds.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "estimation/design.h"

namespace heatsoak::estimation {

struct Posterior {
  Model model;
  std::vector<std::vector<double>> start_C;  ///< start temperatures per run
  std::vector<LinearisedRun> fitted;         ///< free-running simulations of the model
  LatentFlux flux;                           ///< assumed unknown heat
  double evidence_nats = 0.0;
  double cost_nats = 0.0;      ///< half of the sum of squared whitened residuals, those of the priors included
  Eigen::MatrixXd covariance;  ///< posterior covariance of the coordinates; 0 for those at a bound
  bool converged = false;
};

struct PosteriorOptions {
  LatentFlux flux;
  std::vector<Eigen::VectorXd> weights = {};  ///< per run and sample; empty: all 1
  std::vector<int> merged = {};               ///< per run, number of samples per average; empty: no averaging
  double white_noise_K = 0.0;                 ///< if > 0, noise of every sensor in place of its own, for an incomplete model
  int most_steps = 8;                         ///< largest number of Gauss-Newton steps
  /// Chooses the covariance of the residuals, which depends on the parameters, for the test whether a step improves the fit. true: the
  /// covariance before the step, as in iteratively reweighted least squares; a rejected step is replaced by one within a smaller box.
  /// false: the covariance after the step; a rejected step is halved.
  bool holds_covariance = false;
  std::optional<int> held = {};                                         ///< coordinate that keeps its start value
  double longest_step_ratio = std::numeric_limits<double>::infinity();  ///< largest change of a coordinate in one step
  /// Other assumptions about the unknown heat. The covariance is averaged over them with their evidence as weights, so that the intervals
  /// include this uncertainty. The values are those with `flux`. Empty: `flux` alone.
  std::vector<LatentFlux> around = {};
  /// Includes temperature differences within bodies in that average, see uneven_bodies(). false: the network has all bodies of the motor.
  bool has_uneven_bodies = true;
};

/// Standard deviation of the error of an incomplete model. With the noise of the sensors alone every start would look impossible.
inline constexpr double kIncompleteModel_K = 1.0;
/// Largest change of a logarithm in one step: a factor of 1.5.
inline constexpr double kLongestStep_share = 0.4;
/// Returns the options for ordinary least squares of free runs of `model`, without unknown heat.
PosteriorOptions least_squares_options(const Model& model, int most_steps);

/// Fits the model. `start_C` per run as in linearise(). Throws Failure (numerics_failed) if the model cannot be simulated from its start
/// values.
Posterior posterior_of(Model model, const std::vector<MeasuredRun>& runs, std::vector<std::vector<double>> start_C,
                       const PosteriorOptions& options);

/// Continues from a fit with other options or readings. `start.fitted` replaces the first simulation: it is that of its model and start
/// temperatures along these runs, or empty.
Posterior posterior_from(const Posterior& start, const std::vector<MeasuredRun>& runs, const PosteriorOptions& options);

/// Fits a trial model, whose temperatures may diverge: then the evidence is −∞ and the other results are empty. Arguments as in
/// posterior_of().
Posterior try_posterior_of(Model model, const std::vector<MeasuredRun>& runs, std::vector<std::vector<double>> start_C,
                           const PosteriorOptions& options);
/// Same with the arguments of posterior_from().
Posterior try_posterior_from(const Posterior& start, const std::vector<MeasuredRun>& runs, const PosteriorOptions& options);

}  // namespace heatsoak::estimation
