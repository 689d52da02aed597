#include "identify/attribution/refit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/diagnostic.h"
#include "base/parallel.h"
#include "identify/attribution/uneven_bodies.h"
#include "identify/averaged_run.h"
#include "identify/open_loop.h"

namespace heatsoak {
namespace {

/// A fit rests where its next step promises no more: no name hangs on a tenth of a nat.
constexpr double kConverged_nats = 0.1;

/// The prior of the moving coordinates, the others held at `step`.
ThetaPrior prior_given(const ThetaPrior& prior, const std::vector<Eigen::Index>& moving, const Eigen::VectorXd& step) {
  const Eigen::MatrixXd own = prior.precision(moving, moving);
  Eigen::VectorXd held = step - prior.mean;
  held(moving).setZero();
  const Eigen::VectorXd pull = (prior.precision * held)(moving);
  return {own, prior.mean(moving) - Eigen::VectorXd(own.completeOrthogonalDecomposition().solve(pull))};
}

/// Least squares of the moving coordinates, the others held at `step`.
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

/// The step of all coordinates that decreases the squares most while none leaves its bounds (Stark and Parker 1995, bounded-variable
/// least squares): those that would leave are held, and let go again where the squares pull them back inside.
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
  // What the held ones cost before anything is measured counts as well.
  const double misfit = residual().squaredNorm() + (step - prior.mean).dot(prior.precision * (step - prior.mean));
  return {std::move(step), std::move(covariance), fit.log_evidence - 0.5 * (misfit - fit.misfit), misfit};
}

class Fitter {
 public:
  Fitter(ExtendedModel model, const std::vector<MeasuredRun>& runs, std::vector<std::vector<double>> start_C, const RefitOptions& options)
      : runs_(runs), options_(options) {
    now_.model = std::move(model);
    now_.start_C = std::move(start_C);
    now_.place = options.place;
    const Eigen::Index count = now_.model.free_count();
    low_.resize(count);
    high_.resize(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      low_[i] = now_.model.low(i);
      high_[i] = now_.model.high(i);
    }
  }

  RefitResult run() {
    linearise_all(now_);
    EvidenceTable table = table_of(now_);
    for (int step = 0; step < options_.most_steps; ++step) {
      // Far from the best fit its misfit would pass for unknown heat.
      if (step > 0) {
        now_.place = table.best({}, now_.place, Search::rough).place;
      }
      const double misfit = table.misfit_now(now_.place);
      const LinearFit fit = bounded_step(table);
      const double promised = misfit - fit.misfit;
      now_.evidence_nats = fit.log_evidence + options_.grid.log_prior_nats(now_.place);
      now_.covariance = fit.covariance;
      now_.converged = promised < kConverged_nats;
      const bool rests = now_.converged || !take(fit, misfit, table);
      // What no step improves at first may move once the unknown heat is what the misfit asks for.
      if (!rests || step == 0) {
        continue;
      }
      const FluxGrid::Place place = table.best({}, now_.place).place;
      if (place == now_.place) {
        break;
      }
      now_.place = place;
    }
    if (options_.averages_flux) {
      average();
    }
    return std::move(now_);
  }

 private:
  void linearise_all(RefitResult& at) const {
    at.fitted.resize(runs_.size());
    in_parallel(runs_.size(), 0, [&](std::size_t r) { at.fitted[r] = linearise(at.model, at.start_C[r], runs_[r]); });
  }

  [[nodiscard]] EvidenceTable table_of(const RefitResult& at) const {
    return {
        design(at.model.model.network, at.fitted, runs_, options_.errors, options_.merged, {}), options_.grid, prior_here(at.model), {}};
  }

  [[nodiscard]] LinearFit bounded_step(EvidenceTable& table) const {
    const Eigen::VectorXd theta = now_.model.theta();
    return bounded_fit(table.all_runs(now_.place), table.prior_of({}), low_ - theta, high_ - theta);
  }

  /// The places beside the best one, itself among them.
  [[nodiscard]] std::vector<FluxGrid::Place> places_around() const {
    std::vector<FluxGrid::Place> places{now_.place};
    for (std::size_t axis = 0; axis < now_.place.size(); ++axis) {
      const auto count = static_cast<int>(axis + 1 < now_.place.size() ? options_.grid.rms_W.size() : options_.grid.time_scale_s.size());
      const std::size_t known = places.size();
      for (std::size_t i = 0; i < known; ++i) {
        for (const int step : {-1, 1}) {
          FluxGrid::Place place = places[i];
          place[axis] += step;
          if (place[axis] >= 0 && place[axis] < count) {
            places.push_back(place);
          }
        }
      }
    }
    return places;
  }

  /// Mean and covariance over the places around the best: Σ w·(covariance + step·stepᵀ), w by evidence. Bodies may be a little uneven.
  void average() {
    const std::vector<Columns> uneven = uneven_bodies(now_.fitted, runs_);
    std::vector<int> doubts(static_cast<std::size_t>(uneven.front().cols()));
    std::iota(doubts.begin(), doubts.end(), 0);
    EvidenceTable table(design(now_.model.model.network, now_.fitted, runs_, options_.errors, options_.merged, uneven), options_.grid,
                        prior_here(now_.model), std::vector<CandidateColumn>(doubts.size(), {true, kUneven_share}));
    const Eigen::VectorXd theta = now_.model.theta();
    const Eigen::Index count = theta.size();
    const ThetaPrior prior = table.prior_of(doubts);
    Eigen::VectorXd low = Eigen::VectorXd::Constant(prior.mean.size(), -1.0);
    Eigen::VectorXd high = -low;
    low.head(count) = low_ - theta;
    high.head(count) = high_ - theta;
    std::vector<LinearFit> fits;
    double best_nats = -std::numeric_limits<double>::infinity();
    for (const FluxGrid::Place& place : places_around()) {
      fits.push_back(bounded_fit(table.all_runs(place), prior, low, high));
      fits.back().log_evidence += options_.grid.log_prior_nats(place);
      best_nats = std::max(best_nats, fits.back().log_evidence);
    }
    double total_weight = 0.0;
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(prior.mean.size());
    Eigen::MatrixXd square = Eigen::MatrixXd::Zero(mean.size(), mean.size());
    for (const LinearFit& fit : fits) {
      const double weight = std::exp(fit.log_evidence - best_nats);
      total_weight += weight;
      mean += weight * fit.coefficients;
      square += weight * (fit.covariance + fit.coefficients * fit.coefficients.transpose());
    }
    mean /= total_weight;
    now_.evidence_nats = best_nats;
    now_.covariance = (square / total_weight - mean * mean.transpose()).topLeftCorner(count, count);
    try {
      now_ = moved(mean.head(count), start_steps_K(mean, table), 1.0);
    } catch (const Failure&) {
      return;
    }
  }

  /// What the start temperatures do when the coordinates make a step.
  [[nodiscard]] std::vector<Eigen::VectorXd> start_steps_K(const Eigen::VectorXd& step, const EvidenceTable& table) const {
    const LatentFlux flux = options_.grid.at(now_.place);
    std::vector<Eigen::VectorXd> steps_K;
    for (const DesignRun& design : table.runs()) {
      steps_K.push_back(start_correction_K(design.run, design.columns, step, Whitening(design.run, flux, design.noise), design.start));
    }
    return steps_K;
  }

  /// Throws Failure where the temperatures run away.
  [[nodiscard]] RefitResult moved(const Eigen::VectorXd& step, const std::vector<Eigen::VectorXd>& start_step_K, double share) const {
    RefitResult next;
    next.model = now_.model;
    next.model.set_theta((now_.model.theta() + share * step).cwiseMax(low_).cwiseMin(high_));
    next.place = now_.place;
    next.start_C = now_.start_C;
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      next.start_C[r].resize(static_cast<std::size_t>(start_step_K[r].size()), runs_[r].at.front().ambient_C);
      for (Eigen::Index i = 0; i < start_step_K[r].size(); ++i) {
        next.start_C[r][static_cast<std::size_t>(i)] += share * start_step_K[r][i];
      }
    }
    linearise_all(next);
    next.evidence_nats = now_.evidence_nats;
    next.covariance = now_.covariance;
    next.converged = now_.converged;
    return next;
  }

  /// The longest of the halved steps that lowers the squares; false where none does.
  bool take(const LinearFit& fit, double misfit, EvidenceTable& table) {
    const std::vector<Eigen::VectorXd> start_step_K = start_steps_K(fit.coefficients, table);
    for (double share = 1.0; share > 0.05; share *= 0.5) {
      try {
        RefitResult next = moved(fit.coefficients, start_step_K, share);
        EvidenceTable next_table = table_of(next);
        if (next_table.misfit_now(now_.place) < misfit + 1e-9) {
          now_ = std::move(next);
          table = std::move(next_table);
          return true;
        }
      } catch (const Failure&) {
        continue;
      }
    }
    return false;
  }

  const std::vector<MeasuredRun>& runs_;
  const RefitOptions& options_;
  RefitResult now_;
  Eigen::VectorXd low_, high_;
};

}  // namespace

RefitResult refit(ExtendedModel model, const std::vector<MeasuredRun>& runs, std::vector<std::vector<double>> start_C,
                  const RefitOptions& options) {
  return Fitter(std::move(model), runs, std::move(start_C), options).run();
}

RefitResult try_refit(ExtendedModel model, const std::vector<MeasuredRun>& runs, std::vector<std::vector<double>> start_C,
                      const RefitOptions& options) {
  try {
    return refit(std::move(model), runs, std::move(start_C), options);
  } catch (const Failure&) {
    RefitResult none;
    none.place = options.place;
    none.evidence_nats = -std::numeric_limits<double>::infinity();
    return none;
  }
}

void set_wander(SensorNoise& noise, const MeasuredRun& run, const SensorErrors& errors) {
  noise.wander_K.clear();
  for (const Sensor& sensor : run.sensors) {
    if (!errors.wander_K.empty()) {
      const auto found = errors.wander_K.find(sensor.signal);
      noise.wander_K.push_back(found == errors.wander_K.end() ? 0.0 : found->second);
    }
  }
  noise.wander_time_scale_s = errors.wander_time_scale_s;
}

std::vector<DesignRun> design(const Network& network, const std::vector<LinearisedRun>& fitted, const std::vector<MeasuredRun>& runs,
                              const SensorErrors& errors, const std::vector<int>& merged, const std::vector<Columns>& extra) {
  std::vector<DesignRun> all(runs.size());
  in_parallel(runs.size(), 0, [&](std::size_t r) {
    DesignRun& one = all[r];
    const Eigen::VectorXd weight = errors.weights.empty() ? Eigen::VectorXd() : errors.weights[r];
    const Averaging averaging(fitted[r], weight, merged.empty() ? 1 : merged[r]);
    one.run = averaging.run();
    one.noise.weight = averaging.weight();
    one.interval_of = averaging.interval_of();
    for (const Sensor& sensor : runs[r].sensors) {
      one.noise.noise_K.push_back(sensor.noise_K);
    }
    set_wander(one.noise, runs[r], errors);
    const RunStart start = start_of(network, runs[r]);
    one.start = {start.prior_C - fitted[r].state_C.col(0), start.prior_sd_K};
    const Eigen::Index inner = fitted[r].by_parameter.cols();
    one.columns.resize(one.run.residual_K.size(), inner + (extra.empty() ? 0 : extra[r].cols()));
    one.columns.leftCols(inner) = averaging.average(fitted[r].by_parameter);
    if (!extra.empty()) {
      one.columns.rightCols(extra[r].cols()) = averaging.average(extra[r]);
    }
  });
  return all;
}

ThetaPrior prior_here(const ExtendedModel& model) {
  const Prior prior = model.prior();
  return {prior.precision, prior.mean - model.theta()};
}

std::vector<double> measured_start_C(const Network& network, const MeasuredRun& run) {
  const Eigen::VectorXd start_C = start_of(network, run).state_C;
  return {start_C.begin(), start_C.end()};
}

}  // namespace heatsoak
