#include "estimation/posterior.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/diagnostic.h"
#include "base/parallel.h"
#include "estimation/averaged_run.h"
#include "estimation/open_loop.h"
#include "estimation/uneven_bodies.h"

namespace heatsoak::estimation {
namespace {

/// The fit has converged if the next step promises a smaller decrease; differences of 0.1 nats decide nothing.
constexpr double kConverged_nats = 0.1;

/// Returns the prior of the moving coordinates with the others fixed at `step`.
ThetaPrior prior_given(const ThetaPrior& prior, const std::vector<Eigen::Index>& moving, const Eigen::VectorXd& step) {
  const Eigen::MatrixXd own = prior.precision(moving, moving);
  Eigen::VectorXd held = step - prior.mean;
  held(moving).setZero();
  const Eigen::VectorXd pull = (prior.precision * held)(moving);
  return {own, prior.mean(moving) - Eigen::VectorXd(own.completeOrthogonalDecomposition().solve(pull))};
}

/// Solves least squares for the moving coordinates with the others fixed at `step`.
LinearFit fit_moving(const RunEvidence& all, const ThetaPrior& prior, const std::vector<Eigen::Index>& moving,
                     const Eigen::VectorXd& step) {
  const auto inner = static_cast<Eigen::Index>(moving.size());
  Eigen::VectorXd held = step;
  held(moving).setZero();
  Eigen::MatrixXd tall(all.triangle.rows(), inner + 1);
  tall << all.triangle(Eigen::all, moving), all.triangle.rightCols<1>() - all.triangle.leftCols(step.size()) * held;
  if (moving.empty()) {
    return {Eigen::VectorXd(0), Eigen::MatrixXd(0, 0), -0.5 * (tall.squaredNorm() + all.log_determinant), tall.squaredNorm()};
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> decomposition(tall);
  const RunEvidence reduced{decomposition.matrixQR().topRows(inner + 1).triangularView<Eigen::Upper>(), all.log_determinant, all.count};
  const ThetaPrior own = prior_given(prior, moving, step);
  return linear_fit({&reduced, 1}, own.mean, own.precision);
}

/// Solves bounded least squares (Stark and Parker 1995, bounded-variable least squares). A coordinate that would leave its bounds is fixed
/// there, and released again if the gradient points inward.
LinearFit bounded_fit(const RunEvidence& all, const ThetaPrior& prior, const Eigen::VectorXd& low, const Eigen::VectorXd& high) {
  const Eigen::Index count = prior.mean.size();
  const auto data = all.triangle.leftCols(count);
  Eigen::VectorXd step = Eigen::VectorXd::Zero(count).cwiseMax(low).cwiseMin(high);
  const auto residual = [&] { return Eigen::VectorXd(data * step - all.triangle.rightCols<1>()); };
  std::vector<bool> is_held(static_cast<std::size_t>(count), false);
  std::vector<Eigen::Index> moving;
  LinearFit fit;
  for (Eigen::Index round = 0; round < 4 * count + 4; ++round) {
    moving.clear();
    for (Eigen::Index i = 0; i < count; ++i) {
      if (!is_held[static_cast<std::size_t>(i)]) {
        moving.push_back(i);
      }
    }
    fit = fit_moving(all, prior, moving, step);
    double share = 1.0;
    Eigen::Index first = -1;
    for (std::size_t m = 0; m < moving.size(); ++m) {
      const Eigen::Index i = moving[m];
      const double wanted = fit.coefficients[static_cast<Eigen::Index>(m)];
      const double bound = std::clamp(wanted, low[i], high[i]);
      if (bound != wanted && (bound - step[i]) / (wanted - step[i]) < share) {
        share = std::max(0.0, (bound - step[i]) / (wanted - step[i]));
        first = i;
      }
    }
    step(moving) += share * (fit.coefficients - step(moving)).eval();
    if (first >= 0) {
      step[first] = std::clamp(fit.coefficients[std::ranges::find(moving, first) - moving.begin()], low[first], high[first]);
      is_held[static_cast<std::size_t>(first)] = true;
      continue;
    }
    const Eigen::VectorXd slope = data.transpose() * residual() + prior.precision * (step - prior.mean);
    double steepest = 1e-9 * (1.0 + slope.cwiseAbs().maxCoeff());
    for (Eigen::Index i = 0; i < count; ++i) {
      const double inwards = step[i] <= low[i] ? -slope[i] : slope[i];
      if (is_held[static_cast<std::size_t>(i)] && inwards > steepest) {
        steepest = inwards;
        first = i;
      }
    }
    if (first < 0) {
      break;
    }
    is_held[static_cast<std::size_t>(first)] = false;
  }
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(count, count);
  if (!moving.empty()) {
    covariance(moving, moving) = fit.covariance;
  }
  // The prior misfit of the fixed coordinates is part of the evidence.
  const double misfit = residual().squaredNorm() + (step - prior.mean).dot(prior.precision * (step - prior.mean));
  return {std::move(step), std::move(covariance), fit.log_evidence - 0.5 * (misfit - fit.misfit), misfit};
}

class Fitter {
 public:
  /// `fitted` of the start is empty, or the simulation of these runs with its model.
  Fitter(const Posterior& start, const std::vector<MeasuredRun>& runs, const PosteriorOptions& options) : runs_(runs), options_(options) {
    now_.model = start.model;
    now_.start_C = start.start_C;
    now_.fitted = start.fitted;
    now_.flux = options.flux;
    const Eigen::Index count = now_.model.free_count();
    low_.resize(count);
    high_.resize(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      low_[i] = now_.model.low(i);
      high_[i] = now_.model.high(i);
    }
    if (options.held) {
      low_[*options.held] = high_[*options.held] = now_.model.theta()[*options.held];
    }
  }

  Posterior run() {
    if (now_.fitted.empty()) {
      linearise_all(now_);
    }
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      now_.fitted[r].residual_K = (runs_[r].measured_C - now_.fitted[r].sensor_C).transpose().reshaped();
    }
    std::vector<DesignRun> designs = design_of(now_);
    RunEvidence all = all_runs(designs, designs, now_.flux);
    for (int step = 0; step < options_.most_steps; ++step) {
      const double misfit = misfit_of(all, now_);
      now_.cost_nats = 0.5 * misfit;
      const LinearFit fit = bounded_step(all, options_.longest_step_ratio);
      now_.evidence_nats = fit.log_evidence;
      now_.covariance = fit.covariance;
      now_.converged = misfit - fit.misfit < kConverged_nats;
      if (now_.converged) {
        now_.cost_nats -= 0.5 * (misfit - fit.misfit);
      }
      if (now_.converged || !take(all, fit.coefficients, designs)) {
        break;
      }
    }
    if (!options_.around.empty()) {
      average();
    }
    return std::move(now_);
  }

 private:
  void linearise_all(Posterior& at) const {
    at.fitted.resize(runs_.size());
    base::in_parallel(runs_.size(), 0, [&](std::size_t r) { at.fitted[r] = linearise(at.model, at.start_C[r], runs_[r]); });
  }

  [[nodiscard]] std::vector<DesignRun> design_of(const Posterior& at, const std::vector<Columns>& extra = {}) const {
    std::vector<DesignRun> designs = design(at.model.network, at.fitted, runs_, options_.weights, options_.merged, extra);
    for (DesignRun& one : designs) {
      std::ranges::transform(one.noise.noise_K, one.noise.noise_K.begin(),
                             [&](double own_K) { return options_.white_noise_K > 0.0 ? options_.white_noise_K : own_K; });
    }
    return designs;
  }

  /// Returns the triangular factor of [columns, residual] of all runs, whitened by the covariance of `whitened_by`.
  [[nodiscard]] static RunEvidence all_runs(const std::vector<DesignRun>& designs, const std::vector<DesignRun>& whitened_by,
                                            const LatentFlux& flux) {
    std::vector<RunEvidence> each(designs.size());
    base::in_parallel(designs.size(), 0, [&](std::size_t r) {
      const DesignRun& one = designs[r];
      each[r] = run_evidence(one.run, one.columns, Whitening(whitened_by[r].run, flux, whitened_by[r].noise), one.start);
    });
    RunEvidence all{stacked(each), 0.0, 0};
    for (const RunEvidence& run : each) {
      all.log_determinant += run.log_determinant;
      all.count += run.count;
    }
    return all;
  }

  /// Returns the sum of squared whitened residuals at the linearisation point, with optimal start temperatures and the priors included.
  [[nodiscard]] static double misfit_of(const RunEvidence& all, const Posterior& at) {
    const ThetaPrior prior = prior_here(at.model);
    return all.triangle.rightCols<1>().squaredNorm() + prior.mean.dot(prior.precision * prior.mean);
  }

  /// Returns the linear fit within the bounds and at most `longest_step` from the present coordinates.
  [[nodiscard]] LinearFit bounded_step(const RunEvidence& all, double longest_step) const {
    const Eigen::VectorXd theta = now_.model.theta();
    const Eigen::ArrayXd longest = Eigen::ArrayXd::Constant(theta.size(), longest_step);
    return bounded_fit(all, prior_here(now_.model), (low_ - theta).array().max(-longest), (high_ - theta).array().min(longest));
  }

  /// Sets the covariance over all assumptions, with weights by evidence. See PosteriorOptions::around. The values stay: their mean
  /// belongs to a model with uneven bodies, and without these it would predict worse.
  void average() {
    std::vector<Columns> uneven = uneven_bodies(now_.fitted, runs_);
    if (!options_.has_uneven_bodies) {
      std::ranges::for_each(uneven, [](Columns& each) { each.resize(each.rows(), 0); });
    }
    const std::vector<DesignRun> designs = design_of(now_, uneven);
    const Eigen::VectorXd theta = now_.model.theta();
    const Eigen::Index count = theta.size();
    const Eigen::Index uncertain = uneven.front().cols();
    const ThetaPrior own = prior_here(now_.model);
    ThetaPrior prior{Eigen::MatrixXd::Identity(count + uncertain, count + uncertain) / (kUneven_share * kUneven_share),
                     Eigen::VectorXd::Zero(count + uncertain)};
    prior.precision.topLeftCorner(count, count) = own.precision;
    prior.precision.topRightCorner(count, uncertain).setZero();
    prior.precision.bottomLeftCorner(uncertain, count).setZero();
    prior.mean.head(count) = own.mean;
    Eigen::VectorXd low = Eigen::VectorXd::Constant(count + uncertain, -1.0);
    Eigen::VectorXd high = -low;
    low.head(count) = low_ - theta;
    high.head(count) = high_ - theta;
    std::vector<LinearFit> fits;
    double best_nats = -std::numeric_limits<double>::infinity();
    for (const LatentFlux& flux : options_.around) {
      fits.push_back(bounded_fit(all_runs(designs, designs, flux), prior, low, high));
      best_nats = std::max(best_nats, fits.back().log_evidence);
    }
    double total_weight = 0.0;
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(count);
    Eigen::MatrixXd square = Eigen::MatrixXd::Zero(count, count);
    for (const LinearFit& fit : fits) {
      const double weight = std::exp(fit.log_evidence - best_nats);
      const auto step = fit.coefficients.head(count);
      total_weight += weight;
      mean += weight * step;
      square += weight * (fit.covariance.topLeftCorner(count, count) + step * step.transpose());
    }
    mean /= total_weight;
    now_.covariance = square / total_weight - mean * mean.transpose();
  }

  /// Returns the change of the start temperatures in K for a step of the coordinates.
  [[nodiscard]] std::vector<Eigen::VectorXd> start_steps_K(const Eigen::VectorXd& step, const std::vector<DesignRun>& designs) const {
    std::vector<Eigen::VectorXd> steps_K;
    for (const DesignRun& one : designs) {
      steps_K.push_back(start_correction_K(one.run, one.columns, step, Whitening(one.run, now_.flux, one.noise), one.start));
    }
    return steps_K;
  }

  /// Returns the result after a step. Throws Failure if the temperatures diverge.
  [[nodiscard]] Posterior moved(const Eigen::VectorXd& step, const std::vector<Eigen::VectorXd>& start_step_K) const {
    Posterior next;
    next.model = now_.model;
    next.model.set_theta((now_.model.theta() + step).cwiseMax(low_).cwiseMin(high_));
    next.flux = now_.flux;
    next.start_C = now_.start_C;
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      next.start_C[r].resize(static_cast<std::size_t>(start_step_K[r].size()), runs_[r].at.front().ambient_C);
      for (Eigen::Index i = 0; i < start_step_K[r].size(); ++i) {
        next.start_C[r][static_cast<std::size_t>(i)] += start_step_K[r][i];
      }
    }
    linearise_all(next);
    next.evidence_nats = now_.evidence_nats;
    next.covariance = now_.covariance;
    next.converged = now_.converged;
    return next;
  }

  /// Takes `step`, or else the first of several shorter ones that decreases the cost, see PosteriorOptions::holds_covariance. Returns false
  /// if none does. On entry and return, `all` is the evidence of `designs`.
  bool take(RunEvidence& all, Eigen::VectorXd step, std::vector<DesignRun>& designs) {
    constexpr int kTries = 5;
    constexpr double kSmallerBox_ratio = 0.25;
    std::vector<Eigen::VectorXd> start_step_K = start_steps_K(step, designs);
    for (int attempt = 0; attempt < kTries; ++attempt) {
      try {
        Posterior next = moved(step, start_step_K);
        std::vector<DesignRun> next_designs = design_of(next);
        RunEvidence next_all = all_runs(next_designs, options_.holds_covariance ? designs : next_designs, now_.flux);
        next.cost_nats = 0.5 * misfit_of(next_all, next);
        if (next.cost_nats < now_.cost_nats + 1e-9) {
          now_ = std::move(next);
          designs = std::move(next_designs);
          all = options_.holds_covariance ? all_runs(designs, designs, now_.flux) : std::move(next_all);
          return true;
        }
      } catch (const base::Failure&) {
        // The temperatures diverge there: the step is too long.
      }
      if (options_.holds_covariance) {
        step = bounded_step(all, kSmallerBox_ratio * step.cwiseAbs().maxCoeff()).coefficients;
        start_step_K = start_steps_K(step, designs);
      } else {
        step *= 0.5;
        std::ranges::for_each(start_step_K, [](Eigen::VectorXd& each) { each *= 0.5; });
      }
    }
    return false;
  }

  const std::vector<MeasuredRun>& runs_;
  const PosteriorOptions& options_;
  Posterior now_;
  Eigen::VectorXd low_, high_;
};

Posterior start_at(Model model, std::vector<std::vector<double>> start_C) {
  Posterior start;
  start.model = std::move(model);
  start.start_C = std::move(start_C);
  return start;
}

}  // namespace

PosteriorOptions least_squares_options(const Model& model, int most_steps) {
  return {.flux = {std::vector<double>(model.flux_nodes.size(), 0.0)},
          .white_noise_K = kIncompleteModel_K,
          .most_steps = most_steps,
          .holds_covariance = true,
          .longest_step_ratio = kLongestStep_share};
}

Posterior posterior_of(Model model, const std::vector<MeasuredRun>& runs, std::vector<std::vector<double>> start_C,
                       const PosteriorOptions& options) {
  return posterior_from(start_at(std::move(model), std::move(start_C)), runs, options);
}

Posterior posterior_from(const Posterior& start, const std::vector<MeasuredRun>& runs, const PosteriorOptions& options) {
  return Fitter(start, runs, options).run();
}

Posterior try_posterior_of(Model model, const std::vector<MeasuredRun>& runs, std::vector<std::vector<double>> start_C,
                           const PosteriorOptions& options) {
  return try_posterior_from(start_at(std::move(model), std::move(start_C)), runs, options);
}

Posterior try_posterior_from(const Posterior& start, const std::vector<MeasuredRun>& runs, const PosteriorOptions& options) {
  try {
    return posterior_from(start, runs, options);
  } catch (const base::Failure&) {
    Posterior none;
    none.flux = options.flux;
    none.evidence_nats = -std::numeric_limits<double>::infinity();
    none.cost_nats = std::numeric_limits<double>::infinity();
    return none;
  }
}

}  // namespace heatsoak::estimation
