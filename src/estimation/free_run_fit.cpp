#include "estimation/free_run_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "estimation/evidence.h"
#include "estimation/least_squares.h"

namespace heatsoak {
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

LinearisedRun path_of(const Model& model, const Eigen::VectorXd& theta, const RunStart& start, const MeasuredRun& run) {
  std::vector<int> wanted;
  for (const FreeParameter& parameter : model.free) {
    wanted.push_back(parameter.place);
  }
  const Eigen::VectorXd& start_C = start.state_C;
  return linearise(model.network, model.values_at(theta), wanted, {}, {start_C.data(), static_cast<std::size_t>(start_C.size())}, run);
}

bool moves_to_best(const Model& model, std::span<const MeasuredRun> runs, int threads, Eigen::VectorXd& theta,
                   std::vector<RunStart>& starts) {
  constexpr double kUnit_K = 1.0;
  return minimise({.model = &model, .runs = runs, .whitening = {}, .white_noise_K = kUnit_K, .threads = threads}, theta, starts)
      .has_converged;
}

}  // namespace

std::optional<FreeRunFit> fit_free_runs(const Model& model, std::span<const MeasuredRun> runs, Eigen::VectorXd theta,
                                        std::vector<RunStart> starts, int threads) {
  if (!moves_to_best(model, runs, threads, theta, starts)) {
    return std::nullopt;
  }
  FreeRunFit found{std::move(theta), std::move(starts), {}, 0.0};
  std::vector<LinearisedRun> paths;
  double count = 0.0;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    paths.push_back(path_of(model, found.theta, found.starts[r], runs[r]));
    count += static_cast<double>((!paths.back().residual_K.array().isNaN()).count());
  }
  found.rmse_K = free_run_rmse_K(paths);
  const double noise_K = found.rmse_K * std::sqrt(samples_alike(paths, count * found.rmse_K * found.rmse_K));
  std::vector<RunEvidence> evidence;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const Whitening white(paths[r], {{}, 1.0}, {std::vector<double>(runs[r].sensors.size(), noise_K), {}});
    const RunStart& start = found.starts[r];
    evidence.push_back(run_evidence(paths[r], by_theta(model, found.theta, paths[r].by_parameter), white,
                                    {start.prior_C - start.state_C, start.prior_sd_K}));
  }
  found.covariance = linear_fit(evidence, model.prior.mean - found.theta, model.prior.precision).covariance;
  return found;
}

double left_out_rmse_K(const Model& model, std::span<const MeasuredRun> runs, const FreeRunFit& found, int threads) {
  std::vector<LinearisedRun> paths;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const auto out = static_cast<std::ptrdiff_t>(r);
    std::vector<MeasuredRun> others(runs.begin(), runs.end());
    std::vector<RunStart> starts = found.starts;
    others.erase(others.begin() + out);
    starts.erase(starts.begin() + out);
    Eigen::VectorXd theta = found.theta;
    if (others.empty() || !moves_to_best(model, others, threads, theta, starts)) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    paths.push_back(path_of(model, theta, found.starts[r], runs[r]));
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

}  // namespace heatsoak
