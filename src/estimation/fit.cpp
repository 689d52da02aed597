#include "estimation/fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <set>
#include <utility>

#include "base/diagnostic.h"
#include "base/parallel.h"
#include "base/random.h"
#include "estimation/averaged_run.h"
#include "estimation/left_out_runs.h"
#include "estimation/model_along_run.h"
#include "estimation/model_screening.h"
#include "estimation/thresholds.h"
#include "estimation/usual_heat.h"

namespace heatsoak::estimation {
namespace {

using StartsC = std::vector<std::vector<double>>;

/// Starting points in θ: that of the model, then a Latin hypercube around it within the parameters' bounds.
std::vector<Eigen::VectorXd> starting_points(const Model& model, const FitOptions& options) {
  const Eigen::VectorXd centre = model.theta();
  std::vector<Eigen::VectorXd> all(static_cast<std::size_t>(options.starts) + 1, centre);
  base::Random random(options.seed, 0);
  for (Eigen::Index i = 0; i < model.network_count(); ++i) {
    std::vector<int> cell(static_cast<std::size_t>(options.starts));
    std::iota(cell.begin(), cell.end(), 0);
    for (std::size_t k = cell.size(); k > 1; --k) {
      std::swap(cell[k - 1], cell[static_cast<std::size_t>(random.uniform() * static_cast<double>(k))]);
    }
    // Stay within two standard deviations of the prior.
    const double prior_sd = 1.0 / std::sqrt(std::max(model.prior.precision(i, i), 1e-6));
    const double reach = std::min(options.start_spread, 2.0 * prior_sd);
    for (std::size_t k = 0; k < cell.size(); ++k) {
      const double share = (cell[k] + random.uniform()) / static_cast<double>(cell.size());
      all[k + 1][i] = std::clamp(centre[i] + reach * (2.0 * share - 1.0), model.low(i), model.high(i));
    }
  }
  return all;
}

/// Returns the two starting points from which a few steps of least squares lead to the smallest errors, on rows merged to 15 s.
std::vector<Posterior> promising(const Model& model, const std::vector<MeasuredRun>& runs, const StartsC& start_C,
                                 const FitOptions& options) {
  constexpr int kSteps = 3;
  constexpr std::size_t kKept = 2;
  const std::vector<MeasuredRun> rough = roughly(runs);
  const std::vector<Eigen::VectorXd> points = starting_points(model, options);
  std::vector<Posterior> all(points.size());
  base::in_parallel(points.size(), 0, [&](std::size_t i) {
    Model at = model;
    at.set_theta(points[i]);
    all[i] = try_posterior_of(std::move(at), rough, start_C, least_squares_options(model, kSteps));
  });
  std::ranges::stable_sort(all, {}, &Posterior::cost_nats);
  if (!std::isfinite(all.front().cost_nats)) {
    throw base::Failure(base::ExitCode::cannot_answer,
                        "no start of the fit leads to a model with plausible temperatures; check the units of the heat inputs");
  }
  std::erase_if(all, [](const Posterior& each) { return !std::isfinite(each.cost_nats); });
  all.resize(std::min(all.size(), kKept));
  return all;
}

double rms_K(const std::vector<LinearisedRun>& fitted, const std::vector<Eigen::VectorXd>& weights) {
  double sum_K2 = 0.0;
  double count = 0.0;
  for (std::size_t r = 0; r < fitted.size(); ++r) {
    for (Eigen::Index row = 0; row < fitted[r].residual_K.size(); ++row) {
      const double error_K = fitted[r].residual_K[row];
      if (!std::isnan(error_K) && weights[r][row] > 0.0) {
        sum_K2 += error_K * error_K;
        count += 1.0;
      }
    }
  }
  return std::sqrt(sum_K2 / std::max(1.0, count));
}

/// True if whole runs can decide the parameters: there are several, and every body with unknown heat has a sensor.
bool compares_runs(const Model& model, const std::vector<MeasuredRun>& runs) {
  const auto is_sensed = [&](int node) {
    return std::ranges::any_of(runs, [&](const MeasuredRun& run) { return run.sensor_at(model.network.node_name(node)).has_value(); });
  };
  return runs.size() > 1 && std::ranges::all_of(model.flux_nodes, is_sensed);
}

/// Returns the RMS error in K of every run, predicted by plain least squares of the others; ∞ if a fit fails.
double left_out_error_K(const Posterior& plain, const std::vector<MeasuredRun>& runs, const FitSetup& setup) {
  std::vector<LinearisedRun> paths(runs.size());
  std::vector<int> failed(runs.size(), 0);
  base::in_parallel(runs.size(), 0, [&](std::size_t r) {
    const Posterior others = fit_of(some_of(runs, plain, setup.plain(), [&](const MeasuredRun& run) { return &run != &runs[r]; }));
    failed[r] = std::isfinite(others.evidence_nats) ? 0 : 1;
    if (failed[r] == 0) {
      paths[r] = linearise(others.model, plain.start_C[r], runs[r]);
    }
  });
  return std::ranges::count(failed, 1) > 0 ? std::numeric_limits<double>::infinity() : rms_K(paths, setup.weights);
}

/// Replaces the fit by plain least squares of the free runs if that predicts left-out runs clearly better than the fit follows them. If the
/// motor has more bodies than the model, slow unknown heat hides the misfit and biases the parameters.
void prefer_free_runs(const std::vector<MeasuredRun>& runs, const FitSetup& setup, Posterior& now, std::optional<double>& error_K) {
  Posterior plain = try_posterior_from(now, runs, setup.plain());
  const double now_K = rms_K(now.fitted, setup.weights);
  if (!std::isfinite(plain.evidence_nats) || !(now_K > thresholds().clearly_other_ratio * left_out_error_K(plain, runs, setup))) {
    return;
  }
  // Either estimate may be right for a new run, so their difference adds to the uncertainty.
  const Eigen::VectorXd moved = plain.model.theta() - now.model.theta();
  plain.covariance = now.covariance + moved * moved.transpose();
  plain.flux = now.flux;
  error_K = rms_K(plain.fitted, setup.weights);
  now = std::move(plain);
}

/// Posterior at the most probable unknown heat.
struct AtHeat {
  Posterior fit;
  FluxPlace place;
};

/// Alternates between the most probable unknown heat and the posterior, until a heat repeats. Keeps the most probable pair.
AtHeat settle_heat(FirstFit& first, const std::vector<MeasuredRun>& runs, bool with_flux) {
  // Screening along a better fit may change the samples, so the evidence of the first rounds is not comparable.
  constexpr int kScreens = 2;
  constexpr int kMostRounds = 8;
  FitSetup& setup = first.setup;
  const LatentFlux none{std::vector<double>(setup.grid.fluxes, 0.0)};
  AtHeat best{first.fit, setup.grid.middle()};
  Posterior last = std::move(first.fit);
  std::set<FluxPlace> seen;
  for (int round = 0; round < kMostRounds; ++round) {
    const std::vector<DesignRun> designs = design(last.model.network, last.fitted, runs, setup.weights, setup.merged, {});
    const FluxPlace place = most_probable_heat(designs, prior_here(last.model), setup.grid, best.place);
    if (round >= kScreens && !seen.insert(place).second) {
      break;
    }
    last = posterior_from(last, runs, setup.with(with_flux ? setup.grid.at(place) : none));
    if (round <= kScreens || last.evidence_nats > best.fit.evidence_nats) {
      best = {last, place};
    }
    if (round < kScreens) {
      setup.screen(last.fitted, runs);
    }
  }
  return best;
}

/// Gives coordinates at a bound, whose variance is 0, the variance that they would have without the bound.
void free_bounds(const Eigen::MatrixXd& precision, Eigen::MatrixXd& covariance) {
  const Eigen::MatrixXd unbounded = precision.ldlt().solve(Eigen::MatrixXd::Identity(precision.rows(), precision.cols()));
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    covariance(i, i) = covariance(i, i) > 0.0 ? covariance(i, i) : unbounded(i, i);
  }
}

/// Largest unknown heat as a fraction of the mean heat. With more than this even a wrong model would fit, and its parameters would mean
/// nothing.
constexpr double kMostFlux_share = 0.2;

Fit fit_beside_heat(FirstFit first, const std::vector<MeasuredRun>& runs, bool with_flux) {
  // Without candidates the unknown heat stands for everything that is missing, also in runs too short for a steady state.
  first.setup.grid.reach(kMostFlux_share * first.setup.mean_heat_W);
  auto [now, place] = settle_heat(first, runs, with_flux);
  const FitSetup& setup = first.setup;
  const std::vector<DesignRun> designs = design(now.model.network, now.fitted, runs, setup.weights, setup.merged, {});
  const Eigen::Index count = now.model.free_count();
  Fit found;
  found.information = products_of(designs, now.flux, {}).square.topLeftCorner(count, count);
  found.covariance_at_flux = now.covariance;
  found.log_evidence = now.evidence_nats;
  found.flux = now.flux;
  found.has_converged = now.converged;
  if (with_flux) {
    found.is_flux_limited = setup.grid.is_largest(place);
    PosteriorOptions averaged = setup.around(place);
    // The intervals of a calibration are those of its network; a search for missing effects must allow for more bodies.
    averaged.has_uneven_bodies = false;
    now = posterior_from(now, runs, averaged);
    if (compares_runs(now.model, runs)) {
      prefer_free_runs(runs, setup, now, found.free_run_error_K);
    }
  }
  found.theta = now.model.theta();
  found.covariance = std::move(now.covariance);
  const Eigen::MatrixXd precision = found.information + now.model.full_prior().precision;
  free_bounds(precision, found.covariance);
  free_bounds(precision, found.covariance_at_flux);
  found.start_C = std::move(now.start_C);
  found.setup = std::move(first.setup);
  return found;
}

}  // namespace

PosteriorOptions FitSetup::with(const LatentFlux& flux) const { return {.flux = flux, .weights = weights, .merged = merged}; }

PosteriorOptions FitSetup::around(const FluxPlace& place) const {
  PosteriorOptions options = with(grid.at(place));
  std::ranges::transform(grid.star(place), std::back_inserter(options.around), [&](const FluxPlace& each) { return grid.at(each); });
  return options;
}

PosteriorOptions FitSetup::plain() const {
  constexpr int kMostSteps = 20;
  // Halved steps reach the minimum from a start that is wrong by 40 K, where smaller boxes stop early.
  return {.flux = {std::vector<double>(grid.fluxes, 0.0)},
          .weights = weights,
          .merged = merged,
          .white_noise_K = kIncompleteModel_K,
          .most_steps = kMostSteps,
          .longest_step_ratio = kLongestStep_share};
}

void FitSetup::screen(const std::vector<LinearisedRun>& fitted, const std::vector<MeasuredRun>& runs) {
  weights = weights_by_model(fitted, runs, material_W);
}

FirstFit first_fit(const Model& model, const std::vector<MeasuredRun>& runs, const FitOptions& options) {
  StartsC start_C;
  std::ranges::transform(runs, std::back_inserter(start_C), [&](const MeasuredRun& run) { return measured_start_C(model.network, run); });
  std::vector<Posterior> starts(1);
  starts.front().model = model;
  starts.front().start_C = start_C;
  if (options.starts > 0) {
    starts = promising(model, runs, start_C, options);
  }
  FirstFit first;
  FitSetup& setup = first.setup;
  std::vector<LinearisedRun> paths;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    paths.push_back(linearise(starts.front().model, start_C[r], runs[r]));
    setup.merged.push_back(mergeable_samples(paths.back()));
  }
  setup.mean_heat_W = usual_heat_W(model, runs, start_C);
  setup.material_W = material_heat_W(paths, thresholds().material_K);
  setup.grid = flux_grid(setup.material_W, travel_K(runs), model.flux_nodes.size(), model.least_flux_W);
  if (can_leave_out(model, runs)) {
    setup.grid.align();
  }
  base::in_parallel(starts.size(), 0, [&](std::size_t i) {
    starts[i] = posterior_of(std::move(starts[i].model), runs, std::move(starts[i].start_C), setup.plain());
  });
  first.fit = std::move(*std::ranges::min_element(starts, {}, &Posterior::cost_nats));
  setup.screen(first.fit.fitted, runs);
  return first;
}

FluxPlace most_probable_heat(const std::vector<DesignRun>& designs, const ThetaPrior& prior, const FluxGrid& grid, FluxPlace start) {
  return most_probable(grid, std::move(start),
                       [&](const FluxPlace& place) { return reduced(products_of(designs, grid.at(place), {}), prior).base_nats; });
}

double Fit::rejected_share(std::span<const MeasuredRun> runs) const {
  double rejected = 0.0;
  double count = 0.0;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const Eigen::VectorXd readings_C = runs[r].measured_C.transpose().reshaped();
    const auto is_measured = !readings_C.array().isNaN();
    count += static_cast<double>(is_measured.count());
    rejected += static_cast<double>((is_measured && setup.weights[r].array() == 0.0).count());
  }
  return count > 0.0 ? rejected / count : 0.0;
}

double evidence_nats(const Model& model, const std::vector<MeasuredRun>& runs) {
  FirstFit first = first_fit(model, runs, {.starts = 0});
  return settle_heat(first, runs, true).fit.evidence_nats;
}

Fit fit(const Model& model, const std::vector<MeasuredRun>& runs, const FitOptions& options) {
  Fit found;
  // Jobs inside of this one use its threads.
  base::in_parallel(1, options.threads,
                    [&](std::size_t) { found = fit_beside_heat(first_fit(model, runs, options), runs, options.with_flux); });
  return found;
}

}  // namespace heatsoak::estimation
