#include "identify/free_run_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "identify/evidence.h"
#include "identify/least_squares.h"
#include "identify/linearised_run.h"

namespace heatsoak {
namespace {

/// Errors of what two temperatures describe do not change within less.
constexpr double kRow_s = 5.0;

std::vector<MeasuredRun> merged(std::span<const MeasuredRun> runs) {
  std::vector<MeasuredRun> all;
  for (const MeasuredRun& run : runs) {
    const double step_s = (run.time_s.back() - run.time_s.front()) / static_cast<double>(run.at.size());
    constexpr int kLeastRows = 60;
    const int rows = std::min(static_cast<int>(kRow_s / step_s), static_cast<int>(run.at.size()) / kLeastRows);
    all.push_back(rows > 1 ? thinned(run, rows) : run);
  }
  return all;
}

LinearisedRun along(const Model& model, const MeasuredRun& run, const Eigen::VectorXd& theta, const RunStart& start) {
  std::vector<int> wanted;
  for (const FreeParameter& parameter : model.free) {
    wanted.push_back(parameter.place);
  }
  return linearise(model.network, model.values_at(theta), wanted, {},
                   {start.state_C.data(), static_cast<std::size_t>(start.state_C.size())}, run);
}

struct Products {
  double at_once_K2 = 0.0;
  std::vector<double> later_K2;  ///< of errors 1, 2, … rows apart
};

void add_products(const LinearisedRun& run, Products& sums) {
  const auto most = static_cast<std::size_t>(run.samples() / 2);
  sums.later_K2.resize(std::max(sums.later_K2.size(), most), 0.0);
  for (Eigen::Index sensor = 0; sensor < run.sensors(); ++sensor) {
    const Eigen::VectorXd error_K = run.residual_K(Eigen::seq(sensor, run.residual_K.size() - 1, run.sensors()));
    const Eigen::VectorXd known_K = error_K.array().isNaN().select(0.0, error_K);
    sums.at_once_K2 += known_K.squaredNorm();
    for (std::size_t lag = 1; lag <= most; ++lag) {
      const auto rows = known_K.size() - static_cast<Eigen::Index>(lag);
      sums.later_K2[lag - 1] += known_K.head(rows).dot(known_K.tail(rows));
    }
  }
}

/// How many samples say no more than one that is independent.
double samples_alike(const Products& sums) {
  double ratio = 1.0;
  for (std::size_t lag = 0; lag + 1 < sums.later_K2.size(); lag += 2) {
    const double pair_K2 = sums.later_K2[lag] + sums.later_K2[lag + 1];
    if (!(pair_K2 > 0.0)) {
      break;
    }
    ratio += 2.0 * pair_K2 / sums.at_once_K2;
  }
  return ratio;
}

}  // namespace

FreeRunFit fit_free_runs(const Model& model, std::span<const MeasuredRun> runs, Eigen::VectorXd theta, std::vector<RunStart> starts,
                         int threads) {
  const std::vector<MeasuredRun> rows = merged(runs);
  constexpr double kUnit_K = 1.0;
  minimise({.model = &model, .runs = rows, .whitening = {}, .white_noise_K = kUnit_K, .threads = threads}, theta, starts);
  FreeRunFit found{std::move(theta), std::move(starts), {}, 0.0};
  std::vector<LinearisedRun> paths;
  Products sums;
  double count = 0.0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    paths.push_back(along(model, rows[r], found.theta, found.starts[r]));
    add_products(paths.back(), sums);
    count += static_cast<double>((!paths.back().residual_K.array().isNaN()).count());
  }
  found.rmse_K = std::sqrt(sums.at_once_K2 / count);
  const double noise_K = found.rmse_K * std::sqrt(samples_alike(sums));
  std::vector<RunEvidence> evidence;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const SensorNoise noise{std::vector<double>(rows[r].sensors.size(), noise_K), {}};
    const Whitening white(paths[r], {{}, 1.0}, noise);
    const RunStart& start = found.starts[r];
    evidence.push_back(run_evidence(paths[r], by_theta(model, found.theta, paths[r].by_parameter), white,
                                    {start.prior_C - start.state_C, start.prior_sd_K}));
  }
  found.covariance = linear_fit(evidence, model.prior.mean - found.theta, model.prior.precision).covariance;
  return found;
}

double free_run_rmse_K(const Model& model, std::span<const MeasuredRun> runs, const Eigen::VectorXd& theta,
                       const std::vector<RunStart>& starts) {
  const std::vector<MeasuredRun> rows = merged(runs);
  double sum_K2 = 0.0;
  double count = 0.0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const LinearisedRun path = along(model, rows[r], theta, starts[r]);
    for (const double error_K : path.residual_K) {
      sum_K2 += std::isnan(error_K) ? 0.0 : error_K * error_K;
      count += std::isnan(error_K) ? 0.0 : 1.0;
    }
  }
  return std::sqrt(sum_K2 / count);
}

}  // namespace heatsoak
