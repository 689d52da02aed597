// Nonlinear least squares over several runs at once, by Ceres: θ common to all, start temperatures of each run.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "identify/fit.h"
#include "identify/whitening.h"

namespace heatsoak {

struct LeastSquaresProblem {
  const Model* model = nullptr;
  std::span<const MeasuredRun> runs;
  /// One per run, or none: then residuals count by the sensors' own noise alone, which must be `white_noise_K` in K.
  std::span<const Whitening> whitening;
  double white_noise_K = 1.0;
  int held = -1;  ///< place of a free parameter that stays where it is
  int threads = 0;
  int most_iterations = 50;
};

struct LeastSquaresResult {
  double cost = 0.0;  ///< ½ of the sum of squares, priors included
  bool has_converged = false;
};

/// Moves `theta` and the starts' state_C to the minimum. A cost of infinity: the model cannot be run where it starts.
LeastSquaresResult minimise(const LeastSquaresProblem& problem, Eigen::VectorXd& theta, std::vector<RunStart>& starts);

}  // namespace heatsoak
