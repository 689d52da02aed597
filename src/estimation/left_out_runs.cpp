#include "estimation/left_out_runs.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <string>

#include "base/parallel.h"
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
  const Posterior fit = try_posterior_from(start, runs, options);
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

/// Returns the names of the recordings in which no effect of the model is limited to some runs.
std::vector<std::string> without_own_effect(const Model& model, const std::vector<MeasuredRun>& runs) {
  std::set<std::string> names;
  for (const MeasuredRun& run : runs) {
    if (own_effect_count(model, runs, run) == 0) {
      names.insert(recording_of(run));
    }
  }
  return {names.begin(), names.end()};
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

bool is_confirmed(const Eigen::VectorXd& gain_nats, double least_nats) {
  return gain_nats.size() > 1 && gain_nats.sum() - gain_nats.maxCoeff() > least_nats;
}

Posterior fit_of(const SomeRuns& some) { return try_posterior_from(some.start, some.runs, some.options); }

MeasuredRun without_rejected(MeasuredRun run, const Eigen::VectorXd& weight) {
  for (Eigen::Index row = 0; row < weight.size(); ++row) {
    if (!(weight[row] > 0.0)) {
      run.measured_C(row / run.measured_C.cols(), row % run.measured_C.cols()) = std::nan("");
    }
  }
  return run;
}

std::ptrdiff_t own_effect_count(const Model& model, const std::vector<MeasuredRun>& runs, const MeasuredRun& run) {
  const auto effects_in = [&](const MeasuredRun& each) {
    const auto is_met = [&](const auto& term) { return !term.condition.empty() && each.has(term.condition); };
    return std::ranges::count_if(model.conditional, is_met) + std::ranges::count_if(model.deviations, is_met);
  };
  if (const std::ptrdiff_t own = effects_in(run); own > 0 || model.conditional.size() + model.deviations.size() == 0) {
    return own;
  }
  const std::string name = recording_of(run);
  const bool is_only_one_without =
      std::ranges::all_of(runs, [&](const MeasuredRun& each) { return recording_of(each) == name || effects_in(each) > 0; });
  return is_only_one_without ? 1 : 0;
}

bool can_leave_out(const Model& model, const std::vector<MeasuredRun>& runs) {
  constexpr std::size_t kFewest = 3;
  return without_own_effect(model, runs).size() >= kFewest;
}

double left_out_error_K(const Posterior& fit, const std::vector<MeasuredRun>& runs, const PosteriorOptions& options, double largest_K,
                        const Model* usual_in) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  if (!std::isfinite(fit.evidence_nats)) {
    return kInfinite;
  }
  std::vector<MeasuredRun> accepted = runs;
  for (std::size_t r = 0; r < runs.size() && !options.weights.empty(); ++r) {
    accepted[r] = without_rejected(std::move(accepted[r]), options.weights[r]);
  }
  const std::vector<std::string> recordings = without_own_effect(usual_in ? *usual_in : fit.model, runs);
  const auto count = static_cast<double>(recordings.size());
  std::vector<double> squares_K2(recordings.size(), kInfinite);
  std::atomic<double> sum_K2 = 0.0;
  base::in_parallel(recordings.size(), 0, [&](std::size_t i) {
    // The sum so far can only grow.
    if (sum_K2 > largest_K * largest_K * count) {
      return;
    }
    const auto is_own = [&](const MeasuredRun& run) { return recording_of(run) == recordings[i]; };
    const SomeRuns others = some_of(accepted, fit, options, [&](const MeasuredRun& run) { return !is_own(run); });
    const Posterior found = fit_of(others);
    if (std::isfinite(found.evidence_nats)) {
      const SomeRuns own = some_of(accepted, fit, options, is_own);
      const std::optional<Errors> errors = try_open_loop_errors(found.model, own.runs, others.runs);
      squares_K2[i] = errors ? std::pow(rms_K(*errors), 2) : kInfinite;
    }
    sum_K2 += squares_K2[i];
  });
  return std::sqrt(std::reduce(squares_K2.begin(), squares_K2.end()) / count);
}

Posterior more_predictive(Posterior fit, const std::vector<MeasuredRun>& runs, const PosteriorOptions& own, const PosteriorOptions& plain) {
  if (!std::isfinite(fit.evidence_nats)) {
    return fit;
  }
  Posterior other = try_posterior_from(fit, runs, plain);
  if (!std::isfinite(other.evidence_nats)) {
    return fit;
  }
  const auto keeps_own = [&] {
    if (!can_leave_out(fit.model, runs)) {
      return error_of_ends_K(fit, runs, own) <= error_of_ends_K(other, runs, plain);
    }
    // If the errors hardly differ, noise would decide, and the plain fit is worse on average.
    const double largest_K = thresholds().better_share * left_out_error_K(fit, runs, own);
    return left_out_error_K(other, runs, plain, largest_K) >= largest_K;
  };
  if (keeps_own()) {
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
