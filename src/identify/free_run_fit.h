// The figures with which a model follows whole runs best when it runs free: ordinary least squares of its errors in K.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "identify/measured_run.h"
#include "identify/model.h"
#include "identify/open_loop.h"

namespace heatsoak {

struct FreeRunFit {
  Eigen::VectorXd theta;
  std::vector<RunStart> starts;  ///< per run
  /// Of θ: errors that hang together over many samples count as often as they are independent (initial positive sequence, Geyer 1992).
  Eigen::MatrixXd covariance;
  double rmse_K = 0.0;  ///< all sensors alike
};

/// From `theta` and `starts`, on rows merged to some seconds; runs as `fit` takes them.
FreeRunFit fit_free_runs(const Model& model, std::span<const MeasuredRun> runs, Eigen::VectorXd theta, std::vector<RunStart> starts,
                         int threads);

/// Of the errors of a model that runs free from `starts`.
double free_run_rmse_K(const Model& model, std::span<const MeasuredRun> runs, const Eigen::VectorXd& theta,
                       const std::vector<RunStart>& starts);

}  // namespace heatsoak
