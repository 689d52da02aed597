#include "identify/attribution/sensor_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "identify/attribution/refit.h"

namespace heatsoak {
namespace {

constexpr double kShortestWander_s = 4.0;
constexpr double kLongestWander_s = 64.0;
/// So much more probable must a model be with errors of the sensors than without.
constexpr double kClearly_nats = 10.0;

/// The evidence of the model at the fit, at the unknown heat that is best then.
class Trial {
 public:
  /// `designs` as the runs are with faultless sensors.
  Trial(const RefitResult& fit, const std::vector<MeasuredRun>& runs, const FluxGrid& grid, const std::vector<DesignRun>& designs,
        FluxGrid::Place begin)
      : fit_(fit), runs_(runs), grid_(grid), designs_(designs), place_(std::move(begin)) {}

  double evidence_nats(const SensorErrors& errors) {
    std::vector<DesignRun> designs = designs_;
    for (std::size_t r = 0; r < designs.size(); ++r) {
      set_wander(designs[r].noise, runs_[r], errors);
    }
    EvidenceTable table(std::move(designs), grid_, prior_here(fit_.model), {});
    const SetScore best = table.best({}, place_, Search::rough);
    last_ = best.place;
    return best.evidence_nats;
  }
  /// The next trials begin where the last one ended.
  void go_on_there() { place_ = last_; }

 private:
  const RefitResult& fit_;
  const std::vector<MeasuredRun>& runs_;
  const FluxGrid& grid_;
  const std::vector<DesignRun>& designs_;
  FluxGrid::Place place_, last_;
};

/// Doubles and halves one number after the other as long as the evidence grows.
double climb(Trial& trial, SensorErrors& errors) {
  double best_nats = trial.evidence_nats(errors);
  trial.go_on_there();
  const auto try_out = [&](const SensorErrors& next) {
    const double nats = trial.evidence_nats(next);
    if (nats <= best_nats + 0.5) {
      return false;
    }
    best_nats = nats;
    errors = next;
    trial.go_on_there();
    return true;
  };
  constexpr int kMostRounds = 4;
  bool moved = true;
  for (int round = 0; moved && round < kMostRounds; ++round) {
    moved = false;
    for (const double factor : {2.0, 0.5}) {
      for (const auto& [signal, now_K] : std::map(errors.wander_K)) {
        SensorErrors next = errors;
        next.wander_K[signal] *= factor;
        while (try_out(next)) {
          moved = true;
          next.wander_K[signal] *= factor;
        }
      }
      SensorErrors next = errors;
      next.wander_time_scale_s *= factor;
      while (next.wander_time_scale_s >= kShortestWander_s && next.wander_time_scale_s <= kLongestWander_s && try_out(next)) {
        moved = true;
        next.wander_time_scale_s *= factor;
      }
    }
  }
  return best_nats;
}

}  // namespace

std::vector<Eigen::VectorXd> outlier_weights(const RefitResult& fit, const std::vector<MeasuredRun>& runs, const FluxGrid& grid,
                                             const SensorErrors& known) {
  constexpr double kOutlier_sd = 4.5;
  // Where these are many the model has a problem instead, and every sample keeps a say.
  constexpr double kMostOutliers_share = 0.02;
  SensorErrors all = known;
  all.weights.clear();
  std::vector<Eigen::VectorXd> weights(runs.size());
  const std::vector<DesignRun> designs = design(fit.model.model.network, fit.fitted, runs, all, {}, {});
  for (std::size_t r = 0; r < runs.size(); ++r) {
    Columns residual = fit.fitted[r].residual_K;
    Whitening(fit.fitted[r], grid.at(fit.place), designs[r].noise).apply(residual);
    weights[r].setOnes(residual.rows());
    for (Eigen::Index i = 0; i < residual.rows(); ++i) {
      weights[r][i] = std::abs(residual(i, 0)) > kOutlier_sd ? 0.0 : 1.0;
    }
    if (weights[r].sum() < (1.0 - kMostOutliers_share) * static_cast<double>(weights[r].size())) {
      weights[r].setOnes();
    }
  }
  return weights;
}

SensorErrors with_wander(const RefitResult& fit, const std::vector<MeasuredRun>& runs, const FluxGrid& grid, const std::vector<int>& merged,
                         double tolerable_W, SensorErrors known) {
  const LatentFlux flux = grid.at(fit.place);
  if (known.wander_K.empty() && *std::ranges::max_element(flux.rms_W) <= tolerable_W) {
    return known;
  }
  const std::vector<DesignRun> designs = design(fit.model.model.network, fit.fitted, runs, known, merged, {});
  const double without_nats =
      known.wander_K.empty() ? Trial(fit, runs, grid, designs, fit.place).evidence_nats(known) : -std::numeric_limits<double>::infinity();
  // Little unknown heat beside it to begin with: much of it has taken the place of what is looked for.
  FluxGrid::Place little = fit.place;
  std::ranges::fill(little.begin(), little.end() - 1, std::min(3, static_cast<int>(grid.rms_W.size()) - 1));
  constexpr std::array kBegin_noises{2.0, 10.0};
  std::array<SensorErrors, kBegin_noises.size()> wandering;
  std::array<double, kBegin_noises.size()> nats{};
  // Known ones are the beginning themselves.
  const std::size_t begins = known.wander_K.empty() ? kBegin_noises.size() : 1;
  in_parallel(begins, 0, [&](std::size_t i) {
    wandering[i] = known;
    for (const MeasuredRun& run : runs) {
      for (const Sensor& sensor : run.sensors) {
        double& wander_K = wandering[i].wander_K[sensor.signal];
        wander_K = known.wander_K.empty() ? std::max(wander_K, kBegin_noises[i] * sensor.noise_K) : wander_K;
      }
    }
    Trial trial(fit, runs, grid, designs, little);
    nats[i] = climb(trial, wandering[i]);
  });
  const auto best = std::max_element(nats.begin(), nats.begin() + static_cast<std::ptrdiff_t>(begins));
  return *best > without_nats + kClearly_nats ? wandering[static_cast<std::size_t>(best - nats.begin())] : known;
}

}  // namespace heatsoak
