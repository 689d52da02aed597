#include "identify/attribution/first_fit.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "identify/attribution/mean_heat.h"
#include "identify/attribution/open_loop.h"
#include "identify/averaged_run.h"
#include "identify/least_squares.h"

namespace heatsoak {
namespace {

/// A model of which whole runs are off by more may have been fitted into the wrong valley.
constexpr double kFar_K = 1.0;

struct Followed {
  ExtendedModel model;
  std::vector<std::vector<double>> start_C;
};

/// The figures with which whole runs are followed best, roughly, from those of the model; nothing where none can be run.
std::optional<Followed> followed_best(const ExtendedModel& model, const std::vector<MeasuredRun>& runs) {
  const std::vector<MeasuredRun> rough = roughly(runs);
  std::vector<RunStart> starts;
  for (const MeasuredRun& run : rough) {
    starts.push_back(start_of(model.model.network, run));
  }
  // A model that lacks something is off by kelvins, and no run is so long that it would outweigh what the file is sure of.
  constexpr double kMisfit_K = 1.0;
  Eigen::VectorXd theta = model.model.theta();
  if (!std::isfinite(minimise({.model = &model.model, .runs = rough, .whitening = {}, .white_noise_K = kMisfit_K}, theta, starts).cost)) {
    return std::nullopt;
  }
  Followed best{model, {}};
  best.model.model.values = model.model.values_at(theta);
  for (const RunStart& start : starts) {
    best.start_C.emplace_back(start.state_C.begin(), start.state_C.end());
  }
  return best;
}

}  // namespace

FirstFit first_fit(const ExtendedModel& model, const std::vector<MeasuredRun>& runs) {
  FirstFit first;
  first.mean_heat_W = mean_heat_W(model.model, runs);
  RefitOptions& options = first.options;
  options.grid = flux_grid(std::max(0.05, first.mean_heat_W), longest_s(runs) / 2.0);
  options.place.assign(model.model.flux_nodes.size(), 3);
  options.place.push_back(static_cast<int>(options.grid.time_scale_s.size()) / 2);
  first.place = options.place;
  std::vector<std::vector<double>> start_C;
  for (const MeasuredRun& run : runs) {
    start_C.push_back(measured_start_C(model.model.network, run));
    options.merged.push_back(mergeable_samples(linearise(model, start_C.back(), run)));
  }
  first.fit = refit(model, runs, start_C, options);
  // From far away unknown heat may take the place of figures that would do: then the way leads past those.
  constexpr double kFar_ratio = 2.0;
  const double error_K = rms_K(open_loop_errors(first.fit.model, runs, {}));
  if (error_K > kFar_K) {
    const std::optional<Followed> nearer = followed_best(model, runs);
    if (nearer && error_K > kFar_ratio * rms_K(open_loop_errors(nearer->model, runs, {}))) {
      RefitResult other = try_refit(nearer->model, runs, nearer->start_C, options);
      if (other.evidence_nats > first.fit.evidence_nats) {
        first.fit = std::move(other);
      }
    }
  }
  return first;
}

}  // namespace heatsoak
