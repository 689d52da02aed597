// What whitened runs say together: least squares through triangles (TSQR), and how probable the supposed noise and flux are.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "identify/model.h"
#include "identify/whitening.h"

namespace heatsoak {

/// What one run says about c columns, its start temperatures taken out.
struct RunEvidence {
  /// (c + 1) × (c + 1), upper: R of [columns, residual]; its square holds every product of whitened columns.
  Eigen::MatrixXd triangle;
  /// ln|V| + ln|posterior precision of the start| − ln|prior precision of the start|.
  double log_determinant = 0.0;
  Eigen::Index count = 0;  ///< samples
};

/// Knowledge of the start temperatures before the run, per state node. `mean_K` is relative to the linearisation's start.
struct StartPrior {
  Eigen::VectorXd mean_K;
  Eigen::VectorXd sd_K;
};

/// `columns` (n·s × c) are not changed.
RunEvidence run_evidence(const LinearisedRun& run, const Eigen::Ref<const Columns>& columns, const Whitening& whitening,
                         const StartPrior& start);

/// The best correction of the start temperatures in K, given the correction of the c columns' coefficients.
Eigen::VectorXd start_correction_K(const LinearisedRun& run, const Columns& columns, const Eigen::VectorXd& coefficients,
                                   const Whitening& whitening, const StartPrior& start);

/// All runs over each other: again (c + 1) × (c + 1).
Eigen::MatrixXd stacked(std::span<const RunEvidence> runs);

/// Least squares with a Gaussian prior of the coefficients, in the units of the columns.
struct LinearFit {
  Eigen::VectorXd coefficients;
  Eigen::MatrixXd covariance;
  /// −½ [ misfit + ln|V| + ln|H| − ln|Λ| ], up to a constant that depends on the number of samples only; a column without prior
  /// counts as if |Λ| were 1 (§ REML).
  double log_evidence = 0.0;
  double misfit = 0.0;  ///< whitened squares that are left, those of the prior included
};

/// `prior_mean` is relative to where the columns were taken. Directions that neither data nor prior know have a covariance of
/// `kUnknownVariance`.
LinearFit linear_fit(std::span<const RunEvidence> runs, const Eigen::VectorXd& prior_mean, const Eigen::MatrixXd& prior_precision);
inline constexpr double kUnknownVariance = 1e6;

/// ∂/∂θ from ∂/∂value, for the free parameters of a model at θ.
Columns by_theta(const Model& model, const Eigen::VectorXd& theta, const Columns& by_value);

}  // namespace heatsoak
