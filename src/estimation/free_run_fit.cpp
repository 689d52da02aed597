#include "estimation/free_run_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "estimation/evidence.h"
#include "estimation/posterior.h"

namespace heatsoak::estimation {
namespace {

/// Sum of the errors of all sensors for each sample, per run; missing samples count as 0.
std::vector<Eigen::VectorXd> errors_K(std::span<const LinearisedRun> paths) {
  std::vector<Eigen::VectorXd> all;
  for (const LinearisedRun& path : paths) {
    const Eigen::VectorXd known_K = path.residual_K.array().isNaN().select(0.0, path.residual_K);
    all.emplace_back(known_K.reshaped(path.sensors(), path.samples()).colwise().sum().transpose());
  }
  return all;
}

double product_K2(std::span<const Eigen::VectorXd> errors, Eigen::Index apart) {
  double sum_K2 = 0.0;
  for (const Eigen::VectorXd& each : errors) {
    const Eigen::Index rows = each.size() - apart;
    sum_K2 += rows > 0 ? each.head(rows).dot(each.tail(rows)) : 0.0;
  }
  return sum_K2;
}

/// Returns how many correlated samples carry as much information as one independent sample, at least 1. Each lag is one pass over the
/// runs; the loop ends at the first pair of lags without positive correlation.
double samples_alike(std::span<const LinearisedRun> paths, double squares_K2) {
  const std::vector<Eigen::VectorXd> errors = errors_K(paths);
  Eigen::Index longest = 0;
  for (const Eigen::VectorXd& each : errors) {
    longest = std::max(longest, each.size());
  }
  double sum_K2 = -product_K2(errors, 0);
  for (Eigen::Index lag = 0; lag < longest / 2; lag += 2) {
    const double pair_K2 = product_K2(errors, lag) + product_K2(errors, lag + 1);
    if (!(pair_K2 > 0.0)) {
      break;
    }
    sum_K2 += 2.0 * pair_K2;
  }
  return std::max(1.0, sum_K2 / squares_K2);
}

/// Ordinary least squares, every row with the same error. Returns nothing if the search does not converge.
std::optional<Posterior> least_squares(const Model& model, const std::vector<MeasuredRun>& runs,
                                       const std::vector<std::vector<double>>& start_C) {
  constexpr int kMostSteps = 50;
  Posterior found = try_posterior_of(model, runs, start_C, least_squares_options(model, kMostSteps));
  return found.converged ? std::optional(std::move(found)) : std::nullopt;
}

}  // namespace

std::optional<FreeRunFit> fit_free_runs(const Model& model, const std::vector<MeasuredRun>& runs,
                                        const std::vector<std::vector<double>>& start_C) {
  std::optional<Posterior> least = least_squares(model, runs, start_C);
  if (!least) {
    return std::nullopt;
  }
  FreeRunFit found{least->model.theta(), std::move(least->start_C), {}, free_run_rmse_K(least->fitted)};
  double count = 0.0;
  for (const LinearisedRun& path : least->fitted) {
    count += static_cast<double>((!path.residual_K.array().isNaN()).count());
  }
  const double noise_K = found.rmse_K * std::sqrt(samples_alike(least->fitted, count * found.rmse_K * found.rmse_K));
  std::vector<RunEvidence> evidence;
  for (const DesignRun& one : design(model.network, least->fitted, runs, {}, {}, {})) {
    const Whitening white(one.run, {std::vector<double>(model.flux_nodes.size(), 0.0)},
                          {std::vector<double>(one.noise.noise_K.size(), noise_K), {}});
    evidence.push_back(run_evidence(one.run, one.columns, white, one.start));
  }
  const ThetaPrior prior = prior_here(least->model);
  found.covariance = linear_fit(evidence, prior.mean, prior.precision).covariance;
  return found;
}

std::optional<double> left_out_rmse_K(const Model& model, const std::vector<MeasuredRun>& runs, const FreeRunFit& found) {
  Model near = model;
  near.set_theta(found.theta);
  std::vector<LinearisedRun> paths;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const auto out = static_cast<std::ptrdiff_t>(r);
    std::vector<MeasuredRun> others = runs;
    std::vector<std::vector<double>> start_C = found.start_C;
    others.erase(others.begin() + out);
    start_C.erase(start_C.begin() + out);
    const std::optional<Posterior> fit = others.empty() ? std::nullopt : least_squares(near, others, start_C);
    if (!fit) {
      return std::nullopt;
    }
    paths.push_back(linearise(fit->model, found.start_C[r], runs[r]));
  }
  return free_run_rmse_K(paths);
}

double free_run_rmse_K(std::span<const LinearisedRun> paths) {
  double sum_K2 = 0.0;
  double count = 0.0;
  for (const LinearisedRun& path : paths) {
    for (const double error_K : path.residual_K) {
      sum_K2 += std::isnan(error_K) ? 0.0 : error_K * error_K;
      count += std::isnan(error_K) ? 0.0 : 1.0;
    }
  }
  return std::sqrt(sum_K2 / count);
}

}  // namespace heatsoak::estimation
