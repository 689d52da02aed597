// Fits parameters so that a free-running simulation follows whole runs best: ordinary least squares of its errors in K.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "estimation/linearised_run.h"
#include "estimation/measured_run.h"
#include "estimation/model.h"

namespace heatsoak::estimation {

struct FreeRunFit {
  Eigen::VectorXd theta;
  std::vector<std::vector<double>> start_C;  ///< start temperatures per run
  /// Covariance of θ. Errors correlated in time or between sensors count only as many times as they are independent (initial positive
  /// sequence, Geyer 1992).
  Eigen::MatrixXd covariance;
  double rmse_K = 0.0;  ///< over all samples, all sensors weighted equally
};

/// Searches from the present values of the model and `start_C` (one per run). Uses every row, because averages over rows could alias with a
/// periodic load. Returns nullopt if the search does not converge.
std::optional<FreeRunFit> fit_free_runs(const Model& model, const std::vector<MeasuredRun>& runs,
                                        const std::vector<std::vector<double>>& start_C);

/// Leave-one-out cross-validation: RMS error in K of each run, simulated with the parameters fitted to the other runs. The searches start
/// from `found`. Nothing if there is only one run or a search does not converge.
std::optional<double> left_out_rmse_K(const Model& model, const std::vector<MeasuredRun>& runs, const FreeRunFit& found);

/// RMS of residual_K over all samples of all paths, without NaN.
double free_run_rmse_K(std::span<const LinearisedRun> paths);

}  // namespace heatsoak::estimation
