// The figures with which a model follows whole runs best when it runs free: ordinary least squares of its errors in K.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "identify/linearised_run.h"
#include "identify/measured_run.h"
#include "identify/model.h"
#include "identify/open_loop.h"

namespace heatsoak {

struct FreeRunFit {
  Eigen::VectorXd theta;
  std::vector<RunStart> starts;  ///< per run
  /// Of θ: errors that hang together, over time or from sensor to sensor, count as often as they are independent (initial positive
  /// sequence, Geyer 1992).
  Eigen::MatrixXd covariance;
  double rmse_K = 0.0;  ///< all sensors alike
};

/// From `theta` and `starts`; every row counts, for averages over rows would follow a load that repeats like them. Nothing where the search
/// does not come to rest.
std::optional<FreeRunFit> fit_free_runs(const Model& model, std::span<const MeasuredRun> runs, Eigen::VectorXd theta,
                                        std::vector<RunStart> starts, int threads);

/// The same of each run under figures that are fitted to the others, from `found`. NaN where there is but one, or a search fails.
double left_out_rmse_K(const Model& model, std::span<const MeasuredRun> runs, const FreeRunFit& found, int threads);

/// Of models that run free.
double free_run_rmse_K(std::span<const LinearisedRun> paths);

}  // namespace heatsoak
