// Combines whitened runs: linear least squares by stacked triangular factors (TSQR), and the evidence (log marginal likelihood, in nats)
// of the assumed noise and heat flux.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "estimation/model.h"
#include "estimation/whitening.h"

namespace heatsoak::estimation {

/// Information of one run about the coefficients of c columns, with its start temperatures eliminated.
struct RunEvidence {
  /// (c + 1) × (c + 1), upper triangular: the factor R of the whitened [columns, residual]. RᵀR contains all products of these columns.
  Eigen::MatrixXd triangle;
  /// ln|V| + ln|posterior precision of the start temperatures| − ln|their prior precision|.
  double log_determinant = 0.0;
  Eigen::Index count = 0;  ///< samples used
};

/// Gaussian prior of the start temperatures, per state node. `mean_K` is relative to the start of the linearisation.
struct StartPrior {
  Eigen::VectorXd mean_K;
  Eigen::VectorXd sd_K;
};

/// Whitens `columns` (n·s × c) and the run's residual, and eliminates the start temperatures. The arguments are not changed.
RunEvidence run_evidence(const LinearisedRun& run, const Eigen::Ref<const Columns>& columns, const Whitening& whitening,
                         const StartPrior& start);

/// Returns the most probable correction of the start temperatures in K, given the coefficients of the c columns.
Eigen::VectorXd start_correction_K(const LinearisedRun& run, const Columns& columns, const Eigen::VectorXd& coefficients,
                                   const Whitening& whitening, const StartPrior& start);

/// Stacks the factors of all runs and triangularises them again: (c + 1) × (c + 1).
Eigen::MatrixXd stacked(std::span<const RunEvidence> runs);

/// Result of least squares with a Gaussian prior on the coefficients. Coefficients are relative to the linearisation point, in the units
/// of the columns.
struct LinearFit {
  Eigen::VectorXd coefficients;
  Eigen::MatrixXd covariance;
  /// −½ [ misfit + ln|V| + ln|H| − ln|Λ| ] in nats, up to a constant that depends only on the number of samples. H is the posterior and Λ
  /// the prior precision; directions without a prior contribute 1 to |Λ|, as in restricted maximum likelihood (REML;
  /// H. D. Patterson and R. Thompson, 1971).
  double log_evidence = 0.0;
  double misfit = 0.0;  ///< sum of the squared whitened residuals, those of the priors included
};

/// `prior_mean` is relative to the linearisation point. Directions that neither the data nor the prior determine get a coefficient of 0
/// and a variance of `kUnknownVariance`.
LinearFit linear_fit(std::span<const RunEvidence> runs, const Eigen::VectorXd& prior_mean, const Eigen::MatrixXd& prior_precision);
inline constexpr double kUnknownVariance = 1e6;

/// Converts sensitivities ∂/∂value of the free parameters (columns) to ∂/∂θ at `theta`.
Columns by_theta(const Model& model, const Eigen::VectorXd& theta, const Columns& by_value);

}  // namespace heatsoak::estimation
