#include "estimation/left_out_runs.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimation/free_run_errors.h"
#include "estimation/thresholds.h"

namespace heatsoak::estimation {
namespace {

/// Fits the first `seen_share` of every run and returns the RMS error in K of the predicted rest; ∞ if the fit fails.
double error_of_ends_K(const Posterior& start, const std::vector<MeasuredRun>& runs, PosteriorOptions options) {
  const auto seen = [](const MeasuredRun& run) {
    return static_cast<Eigen::Index>(thresholds().seen_share * static_cast<double>(run.samples()));
  };
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const MeasuredRun& run = runs[r];
    const auto sensors = static_cast<Eigen::Index>(run.sensors.size());
    if (options.weights[r].size() == 0) {
      options.weights[r].setOnes(run.samples() * sensors);
    }
    options.weights[r].tail((run.samples() - seen(run)) * sensors).setZero();
  }
  const Posterior fit = try_posterior_of(start.model, runs, start.start_C, options);
  if (!std::isfinite(fit.evidence_nats)) {
    return std::numeric_limits<double>::infinity();
  }
  double sum_K2 = 0.0;
  double count = 0.0;
  for (const MeasuredRun& run : runs) {
    const Eigen::MatrixXd error_K = open_loop_C(fit.model, run, {}) - run.measured_C;
    for (const double each_K : error_K.bottomRows(run.samples() - seen(run)).reshaped()) {
      if (!std::isnan(each_K)) {
        sum_K2 += each_K * each_K;
        count += 1.0;
      }
    }
  }
  return std::sqrt(sum_K2 / std::max(1.0, count));
}

}  // namespace

Products sum_of(const std::vector<Products>& parts, std::optional<std::size_t> left_out) {
  Products sum{Eigen::MatrixXd::Zero(parts.front().square.rows(), parts.front().square.cols())};
  for (std::size_t r = 0; r < parts.size(); ++r) {
    if (r != left_out) {
      sum.square += parts[r].square;
      sum.log_determinant += parts[r].log_determinant;
    }
  }
  return sum;
}

std::vector<Products> by_recording(const std::vector<Products>& parts, const std::vector<MeasuredRun>& runs) {
  std::vector<std::string> names;
  std::vector<Products> sums;
  for (std::size_t r = 0; r < parts.size(); ++r) {
    const auto known = std::ranges::find(names, recording_of(runs[r]));
    if (known == names.end()) {
      names.push_back(recording_of(runs[r]));
      sums.push_back(parts[r]);
    } else {
      Products& sum = sums[static_cast<std::size_t>(known - names.begin())];
      sum.square += parts[r].square;
      sum.log_determinant += parts[r].log_determinant;
    }
  }
  return sums;
}

bool is_confirmed(const Eigen::VectorXd& gain_nats) {
  return gain_nats.size() > 1 && gain_nats.sum() - gain_nats.maxCoeff() > thresholds().clear_nats;
}

Posterior fit_of(const Model& model, const SomeRuns& some) { return try_posterior_of(model, some.runs, some.start_C, some.options); }

Posterior more_predictive(Posterior fit, const std::vector<MeasuredRun>& runs, const PosteriorOptions& own, const PosteriorOptions& plain) {
  if (!std::isfinite(fit.evidence_nats)) {
    return fit;
  }
  Posterior other = try_posterior_of(fit.model, runs, fit.start_C, plain);
  if (!std::isfinite(other.evidence_nats) || error_of_ends_K(fit, runs, own) <= error_of_ends_K(other, runs, plain)) {
    return fit;
  }
  const Eigen::VectorXd moved = other.model.theta() - fit.model.theta();
  other.covariance = fit.covariance + moved * moved.transpose();
  other.flux = fit.flux;
  other.evidence_nats = fit.evidence_nats;
  other.converged = fit.converged;
  return other;
}

}  // namespace heatsoak::estimation
