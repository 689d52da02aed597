// Nonlinear least squares over several runs with Ceres: θ is common to all runs, each run has its own start temperatures.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "estimation/fit.h"
#include "estimation/whitening.h"

namespace heatsoak {

struct LeastSquaresProblem {
  const Model* model = nullptr;
  std::span<const MeasuredRun> runs;
  /// One per run, or empty: then each residual is divided by `white_noise_K`.
  std::span<const Whitening> whitening;
  double white_noise_K = 1.0;
  int held = -1;  ///< index of a free parameter that is kept fixed; −1: none
  int threads = 0;
  int most_iterations = 50;
};

struct LeastSquaresResult {
  double cost = 0.0;  ///< ½ of the sum of squared residuals, priors included
  bool has_converged = false;
};

/// Moves `theta` and the start temperatures (state_C of `starts`) to the minimum. The cost is infinite if the simulation fails at the
/// initial values.
LeastSquaresResult minimise(const LeastSquaresProblem& problem, Eigen::VectorXd& theta, std::vector<RunStart>& starts);

}  // namespace heatsoak
