#include "calibration/forecast/forecast_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/diagnostic.h"
#include "base/parallel.h"
#include "calibration/forecast/trust_region.h"

namespace heatsoak::calibration {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Normal equations of one run. Unknowns: θ, heat factor, start temperature of every node without a sensor.
struct RunTerm {
  estimation::LinearisedRun path;
  Eigen::MatrixXd normal;  ///< normal matrix of these unknowns, without priors and weight
  Eigen::VectorXd right;
  double squares_K2 = 0.0;
  double count = 0.0;
};

bool counts(const RowMask& mask, Eigen::Index row) { return mask.empty() || mask[static_cast<std::size_t>(row)] != 0; }

class Fitting {
 public:
  Fitting(const ForecastModel& model, std::span<const estimation::MeasuredRun> runs, std::span<const RowMask> masks,
          const ForecastRules& rules)
      : model_(model), runs_(runs), rules_(rules), masks_(masks.begin(), masks.end()) {
    masks_.resize(runs.size());
    with_heat_ = rules.has_heat_factors && runs.size() > 1;
    for (const estimation::MeasuredRun& run : runs) {
      std::vector<int> unseen;
      for (int node = 0; node < model.network().state_count(); ++node) {
        if (!run.sensor_at(model.network().node_name(node))) {
          unseen.push_back(node);
        }
      }
      unseen_.push_back(std::move(unseen));
    }
  }

  ForecastFit fit(const Eigen::VectorXd& theta) {
    begin(theta);
    const bool can_simulate = assemble();
    for (int round = 0; can_simulate && round < rules_.rounds; ++round) {
      set_starts();
      assemble();
      set_error(rules_.is_tempered);
      descend(rules_.steps);
    }
    return result();
  }

 private:
  void begin(const Eigen::VectorXd& theta) {
    theta_ = model_.within_bounds(theta);
    heat_log_.setZero(static_cast<Eigen::Index>(runs_.size()));
    starts_.clear();
    for (const estimation::MeasuredRun& run : runs_) {
      starts_.push_back(estimation::start_of(model_.network(), run));
    }
  }

  /// Sets the start of nodes with a sensor from the first samples and the present parameters. The other nodes keep their fitted start.
  void set_starts() {
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      const Eigen::VectorXd decided_C = model_.decided_start(runs_[r], theta_).state_C;
      for (Eigen::Index node = 0; node < decided_C.size(); ++node) {
        if (std::ranges::find(unseen_[r], static_cast<int>(node)) == unseen_[r].end()) {
          starts_[r].state_C[node] = decided_C[node];
        }
      }
    }
  }

  [[nodiscard]] Eigen::Index own_count(std::size_t run) const { return 1 + static_cast<Eigen::Index>(unseen_[run].size()); }

  /// Returns the derivatives of one predicted reading by the unknowns of a run.
  [[nodiscard]] Eigen::VectorXd row_of(std::size_t r, const estimation::LinearisedRun& path, Eigen::Index k) const {
    const Eigen::Index shared = model_.count();
    Eigen::VectorXd row(shared + own_count(r));
    row.head(shared + 1) = path.by_parameter.row(k).transpose();
    for (std::size_t u = 0; u < unseen_[r].size(); ++u) {
      row[shared + 1 + static_cast<Eigen::Index>(u)] = path.by_start(k, unseen_[r][u]);
    }
    return row;
  }

  /// Simulates one run and sets up its normal equations. Order: θ, heat factor, starts of nodes without a sensor.
  [[nodiscard]] RunTerm term(std::size_t r) const {
    RunTerm out;
    const Eigen::VectorXd& start_C = starts_[r].state_C;
    out.path =
        model_.along(runs_[r], theta_, heat_log_[static_cast<Eigen::Index>(r)], {start_C.data(), static_cast<std::size_t>(start_C.size())});
    const Eigen::Index shared = model_.count();
    const Eigen::Index all = shared + own_count(r);
    out.normal.setZero(all, all);
    out.right.setZero(all);
    for (Eigen::Index k = 0; k < out.path.residual_K.size(); ++k) {
      const double error_K = out.path.residual_K[k];
      if (std::isnan(error_K) || !counts(masks_[r], k)) {
        continue;
      }
      const Eigen::VectorXd row = row_of(r, out.path, k);
      out.normal.selfadjointView<Eigen::Lower>().rankUpdate(row);
      out.right += error_K * row;
      out.squares_K2 += error_K * error_K;
      out.count += 1.0;
    }
    out.normal.triangularView<Eigen::StrictlyUpper>() = out.normal.transpose();
    return out;
  }

  /// Updates the terms of all runs. Returns false and keeps the previous terms if the simulation fails.
  bool assemble() {
    std::vector<RunTerm> terms(runs_.size());
    try {
      base::in_parallel(runs_.size(), rules_.threads, [&](std::size_t r) { terms[r] = term(r); });
    } catch (const base::Failure& failure) {
      if (failure.code() != base::ExitCode::numerics_failed) {
        throw;
      }
      return false;
    }
    terms_ = std::move(terms);
    if (rules_.on_simulation) {
      rules_.on_simulation();
    }
    return true;
  }

  void set_error(bool is_tempered) {
    if (rules_.held) {
      out_.error_K = rules_.held->error_K;
      out_.weight = rules_.held->weight;
      return;
    }
    double squares_K2 = 0.0;
    double count = 0.0;
    double independent = 0.0;
    double noise_K2 = 0.0;
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      squares_K2 += terms_[r].squares_K2;
      count += terms_[r].count;
      const Eigen::Index sensors = terms_[r].path.sensors();
      for (Eigen::Index sensor = 0; sensor < sensors; ++sensor) {
        Eigen::VectorXd error_K = terms_[r].path.residual_K(Eigen::seq(sensor, terms_[r].path.residual_K.size() - 1, sensors));
        for (Eigen::Index k = 0; k < error_K.size(); ++k) {
          error_K[k] = counts(masks_[r], k * sensors + sensor) ? error_K[k] : std::nan("");
        }
        independent += independent_samples(error_K);
        const double noise_K = runs_[r].sensors[static_cast<std::size_t>(sensor)].noise_K;
        noise_K2 += noise_K * noise_K * static_cast<double>((!error_K.array().isNaN()).count());
      }
    }
    out_.error_K = std::sqrt(std::max(squares_K2, noise_K2) / std::max(1.0, count));
    out_.weight = is_tempered && count > 0.0 ? std::min(1.0, independent / count) : 1.0;
  }

  [[nodiscard]] double scale_per_K2() const { return out_.weight / (out_.error_K * out_.error_K); }

  [[nodiscard]] double cost() const {
    const Eigen::VectorXd off = theta_ - model_.prior().mean;
    double sum = off.dot(model_.prior().precision * off);
    for (std::size_t r = 0; r < terms_.size(); ++r) {
      sum += scale_per_K2() * terms_[r].squares_K2 + std::pow(heat_log_[static_cast<Eigen::Index>(r)] / kHeatFactor_sd, 2);
      for (const int node : unseen_[r]) {
        sum += std::pow((starts_[r].state_C[node] - starts_[r].prior_C[node]) / starts_[r].prior_sd_K[node], 2);
      }
    }
    return 0.5 * sum;
  }

  /// Normal equations of all runs with priors: θ first, then each run's own unknowns.
  [[nodiscard]] NormalEquations equations() const {
    const Eigen::Index shared = model_.count();
    Eigen::Index all = shared;
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      all += own_count(r);
    }
    NormalEquations out{Eigen::MatrixXd::Zero(all, all), Eigen::VectorXd::Zero(all)};
    out.normal.topLeftCorner(shared, shared) = model_.prior().precision;
    out.right.head(shared) = model_.prior().precision * (model_.prior().mean - theta_);
    Eigen::Index first = shared;
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      const Eigen::Index own = own_count(r);
      const double scale = scale_per_K2();
      out.normal.topLeftCorner(shared, shared) += scale * terms_[r].normal.topLeftCorner(shared, shared);
      out.normal.block(first, first, own, own) = scale * terms_[r].normal.bottomRightCorner(own, own);
      out.normal.block(first, 0, own, shared) = scale * terms_[r].normal.bottomLeftCorner(own, shared);
      out.normal.block(0, first, shared, own) = out.normal.block(first, 0, own, shared).transpose();
      out.right.head(shared) += scale * terms_[r].right.head(shared);
      out.right.segment(first, own) = scale * terms_[r].right.tail(own);
      add_own_priors(r, first, out);
      first += own;
    }
    return out;
  }

  void add_own_priors(std::size_t r, Eigen::Index first, NormalEquations& out) const {
    // A strong prior holds a heat factor that is not fitted at its present logarithm of 0.
    const double heat_precision = with_heat_ ? 1.0 / (kHeatFactor_sd * kHeatFactor_sd) : 1e12;
    out.normal(first, first) += heat_precision;
    out.right[first] -= heat_precision * heat_log_[static_cast<Eigen::Index>(r)];
    for (std::size_t u = 0; u < unseen_[r].size(); ++u) {
      const int node = unseen_[r][u];
      const double precision = 1.0 / (starts_[r].prior_sd_K[node] * starts_[r].prior_sd_K[node]);
      const Eigen::Index own = first + 1 + static_cast<Eigen::Index>(u);
      out.normal(own, own) += precision;
      out.right[own] += precision * (starts_[r].prior_C[node] - starts_[r].state_C[node]);
    }
  }

  void move(const Eigen::VectorXd& step) {
    theta_ = model_.within_bounds(theta_ + step.head(model_.count()));
    Eigen::Index first = model_.count();
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      heat_log_[static_cast<Eigen::Index>(r)] += with_heat_ ? step[first] : 0.0;
      for (std::size_t u = 0; u < unseen_[r].size(); ++u) {
        starts_[r].state_C[unseen_[r][u]] += step[first + 1 + static_cast<Eigen::Index>(u)];
      }
      first += own_count(r);
    }
  }

  /// Returns the bounds and usual changes of all unknowns. The usual change is the prior standard deviation, at most 1 (a factor of e).
  [[nodiscard]] StepLimits limits(const NormalEquations& now) const {
    const Eigen::Index shared = model_.count();
    const Eigen::VectorXd anywhere = Eigen::VectorXd::Constant(shared, kInfinity);
    Eigen::VectorXd priors = Eigen::VectorXd::Zero(now.right.size());
    priors.head(shared) = model_.prior().precision.diagonal();
    StepLimits out{Eigen::VectorXd::Constant(now.right.size(), -kInfinity), Eigen::VectorXd::Constant(now.right.size(), kInfinity), {}};
    out.low.head(shared) = model_.within_bounds(-anywhere) - theta_;
    out.high.head(shared) = model_.within_bounds(anywhere) - theta_;
    Eigen::Index first = shared;
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      if (with_heat_) {
        priors[first] = 1.0 / (kHeatFactor_sd * kHeatFactor_sd);
      } else {
        out.low[first] = out.high[first] = 0.0;
      }
      for (std::size_t u = 0; u < unseen_[r].size(); ++u) {
        priors[first + 1 + static_cast<Eigen::Index>(u)] = std::pow(starts_[r].prior_sd_K[unseen_[r][u]], -2);
      }
      first += own_count(r);
    }
    out.scale = priors.cwiseMax(1.0);
    return out;
  }

  /// Everything that a step changes.
  struct State {
    Eigen::VectorXd theta, heat_log;
    std::vector<estimation::RunStart> starts;
    std::vector<RunTerm> terms;
  };
  [[nodiscard]] State state() const { return {theta_, heat_log_, starts_, terms_}; }
  void restore(State state) {
    theta_ = std::move(state.theta);
    heat_log_ = std::move(state.heat_log);
    starts_ = std::move(state.starts);
    terms_ = std::move(state.terms);
  }

  /// Moves by a step and returns the cost there, or ∞ if the simulation fails.
  double cost_after(const Eigen::VectorXd& step) {
    move(step);
    return assemble() ? cost() : kInfinity;
  }

  /// Corrects a step that was too long for the linear model (second-order correction, Fletcher 1982): the derivatives before the step with
  /// the residuals after it show how to return to the bottom of a curved valley. Returns the cost after the correction, or ∞.
  double cost_corrected(const State& before, const TrustedStep& tried) {
    constexpr double kLongest_share = 0.75;
    std::vector<RunTerm> there = before.terms;
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      there[r].right.setZero();
      for (Eigen::Index k = 0; k < there[r].path.residual_K.size(); ++k) {
        const double error_K = terms_[r].path.residual_K[k];
        if (!std::isnan(error_K) && counts(masks_[r], k)) {
          there[r].right += error_K * row_of(r, there[r].path, k);
        }
      }
    }
    terms_ = std::move(there);
    NormalEquations now = equations();
    const StepLimits limited = limits(now);
    now.right -= tried.damping_ratio * limited.scale.cwiseProduct(tried.step);
    const Eigen::VectorXd correction = bounded_step(now, limited, tried.damping_ratio);
    const bool is_small = limited.length_of(correction) < kLongest_share * limited.length_of(tried.step);
    return is_small ? cost_after(correction) : kInfinity;
  }

  void descend(int steps) {
    // A smaller gain decides nothing: the parameters are within 0.14 standard deviations of the optimum.
    constexpr double kSmall_nats = 0.01;
    constexpr double kLeastRadius = 1e-4;
    constexpr double kGood_ratio = 0.75;
    constexpr double kPoor_ratio = 0.25;
    double best = cost();
    // A start is usually within one prior standard deviation of the optimum.
    double radius = std::sqrt(static_cast<double>(model_.count()));
    for (int step = 0; step < steps; ++step) {
      const NormalEquations now = equations();
      const StepLimits limited = limits(now);
      if (now.gain_of(bounded_step(now, limited, 0.0)) < kSmall_nats) {
        return;
      }
      const State before = state();
      double there = kInfinity;
      while (!(there < best) && radius > kLeastRadius) {
        const TrustedStep next = trusted_step(now, limited, radius);
        const double length = limited.length_of(next.step);
        there = cost_after(next.step);
        const double ratio = (best - there) / now.gain_of(next.step);
        if (!(there < best) && std::isfinite(there)) {
          there = cost_corrected(before, next);
        }
        if (there < best) {
          radius = ratio > kGood_ratio ? std::max(radius, 3.0 * length) : ratio > kPoor_ratio ? radius : length;
        } else {
          restore(before);
          radius = 0.25 * length;
        }
      }
      if (!(there < best)) {
        return;
      }
      best = there;
    }
  }

  ForecastFit result() {
    out_.theta = theta_;
    out_.heat_log = heat_log_;
    out_.starts = starts_;
    if (terms_.empty()) {
      out_.cost_nats = kInfinity;
      return out_;
    }
    set_error(true);
    out_.cost_nats = cost();
    const Eigen::Index shared = model_.count();
    out_.covariance = equations().normal.ldlt().solve(Eigen::MatrixXd::Identity(equations().normal.rows(), shared)).topRows(shared);
    for (const RunTerm& each : terms_) {
      out_.residual_K.push_back(each.path.residual_K);
    }
    return out_;
  }

  const ForecastModel& model_;
  std::span<const estimation::MeasuredRun> runs_;
  const ForecastRules& rules_;
  std::vector<RowMask> masks_;
  bool with_heat_ = false;
  std::vector<std::vector<int>> unseen_;
  Eigen::VectorXd theta_;
  Eigen::VectorXd heat_log_;
  std::vector<estimation::RunStart> starts_;
  std::vector<RunTerm> terms_;
  ForecastFit out_;
};

}  // namespace

ForecastFit fit_forecast(const ForecastModel& model, std::span<const estimation::MeasuredRun> runs, std::span<const RowMask> masks,
                         const Eigen::VectorXd& theta, const ForecastRules& rules) {
  return Fitting(model, runs, masks, rules).fit(theta);
}

double independent_samples(const Eigen::VectorXd& error_K) {
  std::vector<double> known_K;
  std::ranges::copy_if(error_K, std::back_inserter(known_K), [](double each) { return !std::isnan(each); });
  const auto count = static_cast<Eigen::Index>(known_K.size());
  const Eigen::Map<const Eigen::VectorXd> error(known_K.data(), count);
  const double square_K2 = count > 0 ? error.squaredNorm() : 0.0;
  if (!(square_K2 > 0.0)) {
    return static_cast<double>(count);
  }
  double sum = -1.0;
  for (Eigen::Index lag = 0; lag + 1 < count; lag += 2) {
    const double pair =
        (error.head(count - lag).dot(error.tail(count - lag)) + error.head(count - lag - 1).dot(error.tail(count - lag - 1))) / square_K2;
    if (!(pair > 0.0)) {
      break;
    }
    sum += 2.0 * pair;
  }
  return static_cast<double>(count) / std::max(1.0, sum);
}

}  // namespace heatsoak::calibration
