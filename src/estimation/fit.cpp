#include "estimation/fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/diagnostic.h"
#include "base/parallel.h"
#include "base/random.h"
#include "estimation/free_run_fit.h"
#include "estimation/model_along_run.h"
#include "estimation/model_screening.h"
#include "estimation/posterior.h"
#include "estimation/thresholds.h"
#include "estimation/usual_heat.h"

namespace heatsoak::estimation {
namespace {

/// Mean square (kInsideSquare) of a standard normal variable truncated to ±kInside.
constexpr double kInside = 3.0;
constexpr double kInsideSquare = 0.9733;

std::vector<std::string> nodes_of(std::span<const MeasuredRun> runs) {
  std::vector<std::string> nodes;
  for (const MeasuredRun& run : runs) {
    for (const Sensor& sensor : run.sensors) {
      if (std::ranges::find(nodes, sensor.node) == nodes.end()) {
        nodes.push_back(sensor.node);
      }
    }
  }
  return nodes;
}

std::size_t place_of(const std::vector<std::string>& nodes, const std::string& node) {
  return static_cast<std::size_t>(std::ranges::find(nodes, node) - nodes.begin());
}

/// Noise model of a run's sensors. `ratio` (to the model-free noise) and `drift_K` have one entry per entry of `nodes`.
SensorNoise noise_with(const MeasuredRun& run, const std::vector<std::string>& nodes, std::span<const double> ratio,
                       std::span<const double> drift_K, double drift_time_scale_s, const Eigen::VectorXd& weight) {
  SensorNoise noise;
  for (const Sensor& sensor : run.sensors) {
    const std::size_t kind = place_of(nodes, sensor.node);
    noise.noise_K.push_back(sensor.noise_K * ratio[kind]);
    if (!drift_K.empty()) {
      noise.drift_K.push_back(drift_K[kind]);
    }
  }
  noise.drift_time_scale_s = drift_time_scale_s;
  noise.weight = weight;
  return noise;
}

/// Range (maximum − minimum over all runs) of the readings at each node in K, at least 1 K.
std::vector<double> travel_K(const std::vector<std::string>& nodes, std::span<const MeasuredRun> runs) {
  std::vector<double> low_C(nodes.size(), std::numeric_limits<double>::infinity());
  std::vector<double> high_C(nodes.size(), -std::numeric_limits<double>::infinity());
  for (const MeasuredRun& run : runs) {
    for (std::size_t sensor = 0; sensor < run.sensors.size(); ++sensor) {
      const std::size_t kind = place_of(nodes, run.sensors[sensor].node);
      for (const double sensor_C : run.measured_C.col(static_cast<Eigen::Index>(sensor))) {
        low_C[kind] = std::fmin(low_C[kind], sensor_C);
        high_C[kind] = std::fmax(high_C[kind], sensor_C);
      }
    }
  }
  constexpr double kLeast_K = 1.0;
  for (std::size_t kind = 0; kind < nodes.size(); ++kind) {
    high_C[kind] = std::max(kLeast_K, high_C[kind] - low_C[kind]);
  }
  return high_C;
}

/// Returns the runs with samples of weight 0 replaced by NaN.
std::vector<MeasuredRun> without(std::span<const MeasuredRun> runs, const std::vector<Eigen::VectorXd>& weights) {
  std::vector<MeasuredRun> all(runs.begin(), runs.end());
  for (std::size_t r = 0; r < all.size(); ++r) {
    auto by_row = all[r].measured_C.transpose().reshaped();
    by_row = (weights[r].array() > 0.0).select(by_row, std::numeric_limits<double>::quiet_NaN());
  }
  return all;
}

class Fitting {
 public:
  Fitting(const Model& model, std::span<const MeasuredRun> runs, const FitOptions& options)
      : model_(model), runs_(runs.begin(), runs.end()), options_(options), theta_(model.theta()), prior_(model.prior) {
    fit_.sensor_nodes = nodes_of(runs);
    fit_.noise_ratio.assign(fit_.sensor_nodes.size(), 1.0);
    double longest_s = 0.0;
    double usual_step_s = 0.0;
    for (const MeasuredRun& run : runs) {
      starts_.push_back(start_of(model.network, run));
      fit_.weights.emplace_back(Eigen::VectorXd::Ones(run.measured_C.size()));
      longest_s = std::max(longest_s, run.time_s.back() - run.time_s.front());
      usual_step_s = std::max(usual_step_s, (run.time_s.back() - run.time_s.front()) / static_cast<double>(run.at.size()));
    }
    range_.fluxes = model.flux_nodes.size();
    range_.drift_unit_K = travel_K(fit_.sensor_nodes, runs);
    range_.least_W = model.least_flux_W;
    // Unknown heat that is certain to exist varies over minutes; a faster one would average out.
    constexpr double kComesAndGoes_s = 160.0;
    range_.shortest_s = std::max(range_.least_W.empty() ? 20.0 : kComesAndGoes_s, 4.0 * usual_step_s);
    range_.longest_s = std::max(4.0 * range_.shortest_s, longest_s);
    range_.drift_shortest_s = 4.0 * usual_step_s;
    range_.drift_longest_s = std::max(4.0 * range_.drift_shortest_s, 100.0);
    for (const FreeParameter& parameter : model.free) {
      wanted_.push_back(parameter.place);
    }
  }

  Fit run() {
    find_start();
    range_.unit_W = usual_heat_W(model_, runs_, start_C());
    linearise_all();
    constexpr int kMostRounds = 10;
    // Estimate the noise level first, with a plausible flux, because the flux estimate depends on it.
    best_.flux = {std::vector<double>(range_.fluxes, options_.with_flux ? 0.02 * range_.unit_W : 0.0), std::max(range_.shortest_s, 160.0)};
    for (std::size_t i = 0; options_.with_flux && i < range_.least_W.size(); ++i) {
      best_.flux.rms_W[i] = std::max(best_.flux.rms_W[i], range_.least_W[i]);
    }
    look_at_innovations();
    look_at_innovations();
    best_ = {};
    for (fit_.iterations = 1; fit_.iterations <= kMostRounds && !fit_.has_converged; ++fit_.iterations) {
      seek_supposition();
      constexpr int kLooks = 2;
      for (int look = 0; look < kLooks; ++look) {
        look_at_innovations();
      }
      move();
    }
    prefer_free_runs();
    conclude();
    return std::move(fit_);
  }

 private:
  /// Sets θ and the start temperatures to the best of several least-squares fits, which start from the points of a Latin hypercube and
  /// use merged rows and white noise.
  void find_start() {
    const std::vector<MeasuredRun> rough = roughly(runs_);
    std::vector<Posterior> candidates;
    for (const Eigen::VectorXd& point : points(theta_)) {
      Posterior& each = candidates.emplace_back();
      each.model = model_;
      each.model.set_theta(point);
      each.start_C = start_C();
    }
    // Three steps from every point, then up to 30 from the best two.
    for (const auto& [steps, kept] : {std::pair(3, 2), std::pair(30, 1)}) {
      base::in_parallel(candidates.size(), 0, [&, steps = steps](std::size_t i) {
        candidates[i] =
            try_posterior_of(std::move(candidates[i].model), rough, std::move(candidates[i].start_C), least_squares_options(model_, steps));
      });
      std::erase_if(candidates, [](const Posterior& each) { return !std::isfinite(each.cost_nats); });
      std::ranges::stable_sort(candidates, {}, &Posterior::cost_nats);
      candidates.resize(std::min<std::size_t>(candidates.size(), static_cast<std::size_t>(kept)));
    }
    if (candidates.empty()) {
      throw base::Failure(base::ExitCode::cannot_answer,
                          "no start of the fit leads to a model with plausible temperatures; check the units of the heat inputs");
    }
    take(candidates.front());
  }

  [[nodiscard]] std::vector<std::vector<double>> start_C() const {
    std::vector<std::vector<double>> all;
    std::ranges::transform(starts_, std::back_inserter(all),
                           [](const RunStart& start) { return std::vector(start.state_C.begin(), start.state_C.end()); });
    return all;
  }

  /// Moves θ and the start temperatures to those of a fit.
  void take(const Posterior& found) {
    theta_ = found.model.theta();
    for (std::size_t r = 0; r < starts_.size(); ++r) {
      starts_[r].state_C = Eigen::Map<const Eigen::VectorXd>(found.start_C[r].data(), std::ssize(found.start_C[r]));
    }
  }

  [[nodiscard]] Model model_here() const {
    Model here = model_;
    here.set_theta(theta_);
    here.prior = prior_;
    return here;
  }

  /// Starting points in θ: `centre`, then a Latin hypercube around it within the parameters' bounds.
  [[nodiscard]] std::vector<Eigen::VectorXd> points(const Eigen::VectorXd& centre) const {
    std::vector<Eigen::VectorXd> all(static_cast<std::size_t>(options_.starts) + 1, centre);
    base::Random random(options_.seed, 0);
    for (Eigen::Index i = 0; i < centre.size(); ++i) {
      const FreeParameter& parameter = model_.free[static_cast<std::size_t>(i)];
      std::vector<int> cell(static_cast<std::size_t>(options_.starts));
      std::iota(cell.begin(), cell.end(), 0);
      for (std::size_t k = cell.size(); k > 1; --k) {
        std::swap(cell[k - 1], cell[static_cast<std::size_t>(random.uniform() * static_cast<double>(k))]);
      }
      // Stay within two standard deviations of the prior.
      const double prior_sd = 1.0 / std::sqrt(std::max(model_.prior.precision(i, i), 1e-6));
      const double reach = std::min(options_.start_spread, 2.0 * prior_sd);
      for (std::size_t k = 0; k < cell.size(); ++k) {
        const double share = (cell[k] + random.uniform()) / static_cast<double>(cell.size());
        all[k + 1][i] =
            std::clamp(centre[i] + reach * (2.0 * share - 1.0), model_.theta_of(i, parameter.low), model_.theta_of(i, parameter.high));
      }
    }
    return all;
  }

  void linearise_all() {
    linearised_.resize(runs_.size());
    columns_.resize(runs_.size());
    const std::vector<double> values = model_.values_at(theta_);
    base::in_parallel(runs_.size(), 0, [&](std::size_t r) {
      const Eigen::VectorXd& start_C = starts_[r].state_C;
      linearised_[r] = linearise(model_.network, values, wanted_, model_.flux_nodes,
                                 {start_C.data(), static_cast<std::size_t>(start_C.size())}, runs_[r]);
      columns_[r] = by_theta(model_, theta_, linearised_[r].by_parameter);
    });
  }

  [[nodiscard]] Whitening whitening(std::size_t r, const Supposition& supposed) const {
    return {linearised_[r], supposed.flux,
            noise_with(runs_[r], fit_.sensor_nodes, fit_.noise_ratio, supposed.drift_K, supposed.drift_time_scale_s, fit_.weights[r])};
  }
  [[nodiscard]] StartPrior start_prior(std::size_t r) const { return {starts_[r].prior_C - starts_[r].state_C, starts_[r].prior_sd_K}; }

  /// Linear fit for each supposition at the present linearisation. Each pair of supposition and run is one parallel job.
  std::vector<LinearFit> fits(const std::vector<Supposition>& suppositions) const {
    std::vector<RunEvidence> all(suppositions.size() * runs_.size());
    base::in_parallel(all.size(), 0, [&](std::size_t job) {
      const std::size_t r = job % runs_.size();
      all[job] = run_evidence(linearised_[r], columns_[r], whitening(r, suppositions[job / runs_.size()]), start_prior(r));
    });
    std::vector<LinearFit> results;
    for (std::size_t i = 0; i < suppositions.size(); ++i) {
      results.push_back(linear_fit(std::span(all).subspan(i * runs_.size(), runs_.size()), prior_.mean - theta_, prior_.precision));
    }
    return results;
  }
  std::vector<double> evidences(const std::vector<Supposition>& suppositions) const {
    std::vector<double> all;
    for (const LinearFit& each : fits(suppositions)) {
      all.push_back(each.log_evidence);
    }
    return all;
  }

  /// Sets best_ to the most probable supposition. Adds sensor drift if the unknown heat is otherwise large and the evidence clearly prefers
  /// drift.
  void seek_supposition() {
    if (!options_.with_flux) {
      best_.flux = {std::vector<double>(range_.fluxes, 0.0), range_.longest_s};
      return;
    }
    const Evidence evidence = [&](const auto& suppositions) { return evidences(suppositions); };
    best_ = most_probable(evidence, range_, best_);
    bool is_much = false;
    for (std::size_t i = 0; i < range_.fluxes; ++i) {
      const bool is_certain = !range_.least_W.empty() && range_.least_W[i] > 0.0;
      is_much = is_much || (!is_certain && best_.flux.rms_W[i] > thresholds().material_share * range_.unit_W);
    }
    if (best_.drift_K.empty() && is_much) {
      const Supposition drifting = most_probable(evidence, range_, with_drift(range_, best_));
      const std::vector<double> values = evidences({best_, drifting});
      best_ = values[1] > values[0] + thresholds().clear_nats ? drifting : best_;
    }
  }

  /// Updates the noise level of each kind of sensor and the outlier weights from the innovations after the best linear correction.
  void look_at_innovations() {
    const Eigen::VectorXd coefficients = fits({best_}).front().coefficients;
    std::vector<double> weight_sum(fit_.sensor_nodes.size(), 0.0);
    std::vector<double> square_sum(fit_.sensor_nodes.size(), 0.0);
    const double suspect_sd = thresholds().suspect_sd, most_sd = rejected_sd();
    std::size_t rejected = 0;
    std::size_t counted = 0;
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      const LinearisedRun& run = linearised_[r];
      const Whitening whitened = whitening(r, best_);
      const Eigen::VectorXd start_K = start_correction_K(run, columns_[r], coefficients, whitened, start_prior(r));
      const Eigen::VectorXd residual_K = run.residual_K - columns_[r] * coefficients - run.by_start * start_K;
      const Innovations found = whitened.innovations(residual_K);
      std::size_t hopeless = 0;
      for (Eigen::Index row = 0; row < residual_K.size(); ++row) {
        const double size = std::abs(found.standardised[row]);
        if (std::isnan(size)) {
          continue;
        }
        ++counted;
        hopeless += size > most_sd ? 1 : 0;
        fit_.weights[r][row] = std::min(1.0, suspect_sd / size);
        if (size < kInside) {
          const std::size_t kind = place_of(fit_.sensor_nodes, runs_[r].sensors[static_cast<std::size_t>(row % run.sensors())].node);
          weight_sum[kind] += found.noise_share[row];
          square_sum[kind] += found.noise_share[row] * size * size / kInsideSquare;
        }
      }
      if (static_cast<double>(hopeless) < thresholds().most_rejected_share * static_cast<double>(whitened.count())) {
        for (Eigen::Index row = 0; row < residual_K.size(); ++row) {
          if (std::abs(found.standardised[row]) > most_sd) {
            fit_.weights[r][row] = 0.0;
            ++rejected;
          }
        }
      }
    }
    for (std::size_t kind = 0; kind < weight_sum.size(); ++kind) {
      const double change = weight_sum[kind] > 0.0 ? std::sqrt(square_sum[kind] / weight_sum[kind]) : 1.0;
      fit_.noise_ratio[kind] = std::clamp(fit_.noise_ratio[kind] * std::clamp(change, 0.5, 3.0), 0.2, 1000.0);
    }
    fit_.rejected_share = counted > 0 ? static_cast<double>(rejected) / static_cast<double>(counted) : 0.0;
  }

  /// Moves θ and the start temperatures to the posterior maximum for the present unknown heat and noise.
  void move() {
    PosteriorOptions options{.flux = best_.flux, .holds_covariance = true, .longest_step_ratio = kLongestStep_share};
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      options.noise.push_back(
          noise_with(runs_[r], fit_.sensor_nodes, fit_.noise_ratio, best_.drift_K, best_.drift_time_scale_s, fit_.weights[r]));
    }
    const Eigen::VectorXd before = theta_;
    const Posterior found = posterior_of(model_here(), runs_, start_C(), options);
    take(found);
    linearise_all();
    constexpr double kSmall = 0.1;
    const Eigen::ArrayXd sd = found.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
    fit_.has_converged = fit_.iterations >= 2 && found.converged && ((theta_ - before).array().abs() <= kSmall * sd).all();
  }

  /// Replaces θ by the result of the free-run fit if that predicts whole runs clearly better, left-out runs included, and by more than
  /// chance. If the motor has more bodies than the model, slow unknown heat hides the misfit and biases the parameters; the free-run fit
  /// predicts better.
  void prefer_free_runs() {
    if (!options_.with_flux || fit_.sensor_nodes.size() < model_.flux_nodes.size()) {
      return;
    }
    const double clearly_ratio = thresholds().clearly_other_ratio;
    const double now_K = free_run_rmse_K(linearised_);
    const double least_K = std::ranges::min(runs_.front().sensors, {}, &Sensor::noise_K).noise_K;
    // No parameters can predict better than the sensors' noise allows.
    if (now_K < clearly_ratio * least_K) {
      return;
    }
    const std::vector<MeasuredRun> counted = without(runs_, fit_.weights);
    const std::optional<FreeRunFit> search = fit_free_runs(model_here(), counted, start_C());
    if (!search || now_K < clearly_ratio * search->rmse_K) {
      return;
    }
    const FreeRunFit& found = *search;
    // Test whether the two estimates differ more than their covariances allow (after Hausman 1978). The covariances are added, because
    // neither estimate is efficient if the model is wrong.
    const Eigen::VectorXd apart = found.theta - theta_;
    const LinearFit here = fits({best_}).front();
    const Eigen::MatrixXd allowed = found.covariance + here.covariance;
    if (apart.dot(allowed.ldlt().solve(apart)) < thresholds().beyond_chance_ratio * static_cast<double>(apart.size())) {
      return;
    }
    // Guards against overfitting a single run: the parameters must predict left-out runs equally well.
    if (const std::optional<double> unseen_K = left_out_rmse_K(model_here(), counted, found);
        !unseen_K || !(now_K > clearly_ratio * *unseen_K)) {
      return;
    }
    fit_.free_run_error_K = found.rmse_K;
    fit_.log_evidence = here.log_evidence;
    theta_ = found.theta;
    for (std::size_t r = 0; r < starts_.size(); ++r) {
      starts_[r].state_C = Eigen::Map<const Eigen::VectorXd>(found.start_C[r].data(), std::ssize(found.start_C[r]));
    }
    // Either estimate may be right for a new run, so their difference adds to the prior's uncertainty.
    prior_ = {theta_, (found.covariance + 0.25 * apart * apart.transpose()).inverse()};
    linearise_all();
    best_ = {};
    seek_supposition();
    // Limit the unknown heat so that its effect on free runs is not larger than their error.
    const double most_share = found.rmse_K / std::sqrt(mean_square_by_flux_K2());
    for (double& rms_W : best_.flux.rms_W) {
      rms_W *= std::min(1.0, most_share);
    }
  }

  /// Variance that the assumed heat flux causes in the sensors of free runs, mean over all samples.
  [[nodiscard]] double mean_square_by_flux_K2() const {
    double sum_K2 = 0.0;
    double count = 0.0;
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      const LinearisedRun& run = linearised_[r];
      constexpr double kUnit_K = 1.0;
      const SensorNoise unseen{std::vector<double>(run.sensor_node.size(), kUnit_K), Eigen::VectorXd::Zero(run.residual_K.size())};
      for (const double share : Whitening(run, best_.flux, unseen).innovations(run.residual_K).noise_share) {
        sum_K2 += std::isnan(share) ? 0.0 : kUnit_K * kUnit_K * (1.0 / share - 1.0);
        count += std::isnan(share) ? 0.0 : 1.0;
      }
    }
    return sum_K2 / count;
  }

  void conclude() {
    std::vector<WeightedSupposition> around{{best_, 1.0}};
    if (options_.with_flux && !fit_.free_run_error_K) {
      around = suppositions_around([&](const auto& suppositions) { return evidences(suppositions); }, range_, best_);
    }
    std::vector<Supposition> suppositions;
    for (const WeightedSupposition& each : around) {
      suppositions.push_back(each.supposition);
    }
    const std::vector<LinearFit> all = fits(suppositions);
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(theta_.size());
    for (std::size_t h = 0; h < all.size(); ++h) {
      mean += around[h].weight * all[h].coefficients;
    }
    fit_.covariance.setZero(theta_.size(), theta_.size());
    for (std::size_t h = 0; h < all.size(); ++h) {
      const Eigen::VectorXd off = all[h].coefficients - mean;
      fit_.covariance += around[h].weight * (all[h].covariance + off * off.transpose());
      fit_.hypotheses.push_back({suppositions[h], around[h].weight, theta_ + all[h].coefficients, all[h].covariance});
    }
    if (fit_.free_run_error_K) {
      fit_.covariance = prior_.precision.inverse();
      fit_.hypotheses.front().theta = theta_;
      fit_.hypotheses.front().covariance = fit_.covariance;
    }
    fit_.theta = theta_;
    fit_.flux = best_.flux;
    fit_.usual_heat_W = range_.unit_W;
    fit_.drift_K = best_.drift_K;
    fit_.drift_time_scale_s = best_.drift_time_scale_s;
    fit_.starts = starts_;
    if (!fit_.free_run_error_K) {
      fit_.log_evidence = fits({best_}).front().log_evidence;
    }
    std::vector<RunEvidence> data;
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      data.push_back(run_evidence(linearised_[r], columns_[r], whitening(r, best_), start_prior(r)));
    }
    fit_.data_triangle = stacked(data);
  }

  const Model& model_;
  std::vector<MeasuredRun> runs_;
  const FitOptions& options_;
  Fit fit_;
  Eigen::VectorXd theta_;
  Prior prior_;
  std::vector<RunStart> starts_;
  std::vector<int> wanted_;
  SuppositionRange range_;
  Supposition best_;
  std::vector<LinearisedRun> linearised_;
  std::vector<Columns> columns_;
};

}  // namespace

Fit fit(const Model& model, std::span<const MeasuredRun> runs, const FitOptions& options) {
  Fit found;
  // Jobs inside of this one use its threads.
  base::in_parallel(1, options.threads, [&](std::size_t) { found = Fitting(model, runs, options).run(); });
  return found;
}

SensorNoise noise_of(const MeasuredRun& run, const Fit& fit, std::size_t run_index) {
  return noise_with(run, fit.sensor_nodes, fit.noise_ratio, fit.drift_K, fit.drift_time_scale_s, fit.weights[run_index]);
}

}  // namespace heatsoak::estimation
