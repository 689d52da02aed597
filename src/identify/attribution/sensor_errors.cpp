#include "identify/attribution/sensor_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "base/parallel.h"
#include "identify/attribution/refit.h"

namespace heatsoak {
namespace {

constexpr double kShortestWander_s = 4.0;
constexpr double kLongestWander_s = 64.0;
/// So much more probable must a model be with errors of the sensors than without.
constexpr double kClearly_nats = 10.0;
/// What a step has to bring, and how far behind it may be before other unknown heat beside it is looked for: that mostly brings a few.
constexpr double kBetter_nats = 0.5;
constexpr double kHopeless_nats = 15.0;

/// To the slow errors under which the model at the fit is most probable, the unknown heat being what is best beside them.
class Climb {
 public:
  /// `designs` as the runs are with faultless sensors; `place` is where the search for the unknown heat begins.
  Climb(const RefitResult& fit, const std::vector<MeasuredRun>& runs, const FluxGrid& grid, const std::vector<DesignRun>& designs,
        FluxGrid::Place place)
      : fit_(fit), runs_(runs), grid_(grid), designs_(designs), place_(std::move(place)) {}

  double evidence_nats(const SensorErrors& errors) {
    const SetScore best = table(errors).best({}, place_, Search::rough);
    place_ = best.place;
    return best.evidence_nats;
  }

  /// Doubles and halves one number after the other as long as the evidence grows; returns the evidence.
  double run(SensorErrors& errors) {
    best_nats_ = evidence_nats(errors);
    tried_ = {{errors.wander_time_scale_s, errors.wander_K}};
    constexpr int kMostRounds = 4;
    bool moved = true;
    for (int round = 0; moved && round < kMostRounds; ++round) {
      moved = false;
      for (const double factor : {2.0, 0.5}) {
        for (const auto& [signal, now_K] : std::map(errors.wander_K)) {
          while (steps_to(errors, [&, &name = signal](SensorErrors& next) { next.wander_K[name] *= factor; })) {
            moved = true;
          }
        }
        while (steps_to(errors, [&](SensorErrors& next) { next.wander_time_scale_s *= factor; })) {
          moved = true;
        }
      }
      if (moved) {
        best_nats_ = evidence_nats(errors);
      }
    }
    return best_nats_;
  }

 private:
  [[nodiscard]] EvidenceTable table(const SensorErrors& errors) const {
    std::vector<DesignRun> designs = designs_;
    for (std::size_t r = 0; r < designs.size(); ++r) {
      set_wander(designs[r].noise, runs_[r], errors);
    }
    return {std::move(designs), grid_, prior_here(fit_.model), {}};
  }

  /// False where it brings nothing. Other unknown heat is looked for only where it may decide.
  template <class Change>
  bool steps_to(SensorErrors& errors, const Change& change) {
    SensorErrors next = errors;
    change(next);
    if (next.wander_time_scale_s < kShortestWander_s || next.wander_time_scale_s > kLongestWander_s ||
        !tried_.emplace(next.wander_time_scale_s, next.wander_K).second) {
      return false;
    }
    EvidenceTable beside = table(next);
    double nats = beside.score({}, place_).evidence_nats;
    if (nats <= best_nats_ + kBetter_nats && nats > best_nats_ - kHopeless_nats) {
      const SetScore best = beside.best({}, place_, Search::rough);
      nats = best.evidence_nats;
      if (nats > best_nats_ + kBetter_nats) {
        place_ = best.place;
      }
    }
    if (nats <= best_nats_ + kBetter_nats) {
      return false;
    }
    best_nats_ = nats;
    errors = std::move(next);
    return true;
  }

  const RefitResult& fit_;
  const std::vector<MeasuredRun>& runs_;
  const FluxGrid& grid_;
  const std::vector<DesignRun>& designs_;
  FluxGrid::Place place_;
  double best_nats_ = 0.0;
  std::set<std::pair<double, std::map<std::string, double>>> tried_;
};

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
                         SensorErrors known) {
  const std::vector<DesignRun> designs = design(fit.model.model.network, fit.fitted, runs, known, merged, {});
  // Little unknown heat beside it to begin with: much of it has taken the place of what is looked for.
  FluxGrid::Place little = fit.place;
  std::ranges::fill(little.begin(), little.end() - 1, std::min(3, static_cast<int>(grid.rms_W.size()) - 1));
  constexpr std::array kBegin_noises{2.0, 10.0};
  std::vector<SensorErrors> wandering(kBegin_noises.size(), known);
  std::vector<double> nats(wandering.size());
  in_parallel(wandering.size(), 0, [&](std::size_t i) {
    for (const MeasuredRun& run : runs) {
      for (const Sensor& sensor : run.sensors) {
        double& wander_K = wandering[i].wander_K[sensor.signal];
        wander_K = std::max(wander_K, kBegin_noises[i] * sensor.noise_K);
      }
    }
    nats[i] = Climb(fit, runs, grid, designs, little).run(wandering[i]);
  });
  const auto best = static_cast<std::size_t>(std::ranges::max_element(nats) - nats.begin());
  const double without_nats = Climb(fit, runs, grid, designs, fit.place).evidence_nats(known);
  return nats[best] > without_nats + kClearly_nats ? std::move(wandering[best]) : known;
}

SensorErrors wander_at(const RefitResult& fit, const std::vector<MeasuredRun>& runs, const FluxGrid& grid, const std::vector<int>& merged,
                       SensorErrors known) {
  if (!known.wander_K.empty()) {
    const std::vector<DesignRun> designs = design(fit.model.model.network, fit.fitted, runs, known, merged, {});
    Climb(fit, runs, grid, designs, fit.place).run(known);
  }
  return known;
}

}  // namespace heatsoak
