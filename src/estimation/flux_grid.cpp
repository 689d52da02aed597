#include "estimation/flux_grid.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <ranges>
#include <utility>

namespace heatsoak::estimation {
namespace {

/// Ratio of neighbouring RMS values.
constexpr double kStep_ratio = 2.25;
/// Largest RMS value of a grid, in units of the heat that matters.
constexpr double kLargest_ratio = 8.0;

/// Returns the steady temperature rise of the warmest node in K/W, as a mean over the runs. The heat enters the flux node with the smallest
/// such rise, the outermost body.
double steady_rise_K_per_W(const std::vector<LinearisedRun>& runs) {
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Index x = runs.front().states;
  const Eigen::Index q = runs.front().fluxes;
  Eigen::MatrixXd lost = Eigen::MatrixXd::Zero(x, x);
  Eigen::MatrixXd gained = Eigen::MatrixXd::Zero(x, q);
  for (const LinearisedRun& run : runs) {
    for (Eigen::Index k = 0; k + 1 < run.samples(); ++k) {
      lost += Eigen::MatrixXd::Identity(x, x) - Eigen::Map<const Square>(run.transition.data() + k * x * x, x, x);
      gained += Eigen::Map<const Square>(run.injection.data() + k * x * q, x, q);
    }
  }
  return (lost.colPivHouseholderQr().solve(gained)).colwise().maxCoeff().minCoeff();
}

}  // namespace

double material_heat_W(const std::vector<LinearisedRun>& runs, double rise_K) { return rise_K / std::max(1e-6, steady_rise_K_per_W(runs)); }

double travel_K(std::span<const MeasuredRun> runs) {
  double sum_K2 = 0.0;
  double count = 0.0;
  for (const MeasuredRun& run : runs) {
    for (const auto sensor_C : run.measured_C.colwise()) {
      const auto usable = [](double each_C) { return !std::isnan(each_C); };
      std::vector<double> all_C;
      std::ranges::copy_if(sensor_C, std::back_inserter(all_C), usable);
      if (!all_C.empty()) {
        const auto [low, high] = std::ranges::minmax(all_C);
        sum_K2 += (high - low) * (high - low);
        count += 1.0;
      }
    }
  }
  return count > 0.0 ? std::sqrt(sum_K2 / count) : 0.0;
}

LatentFlux FluxGrid::at(const FluxPlace& place) const {
  LatentFlux flux;
  for (std::size_t f = 0; f < fluxes; ++f) {
    flux.rms_W.push_back(std::max(rms_W[static_cast<std::size_t>(place[f])], least_W.empty() ? 0.0 : least_W[f]));
  }
  flux.time_scale_s = time_scale_s[static_cast<std::size_t>(place[fluxes])];
  flux.drift_K = drift_K[static_cast<std::size_t>(place[fluxes + 1])];
  flux.drift_time_scale_s = drift_time_scale_s[static_cast<std::size_t>(place[fluxes + 2])];
  return flux;
}

FluxPlace FluxGrid::middle() const {
  FluxPlace place(fluxes, static_cast<int>(rms_W.size()) / 2 - 1);
  place.push_back(static_cast<int>(time_scale_s.size()) / 2);
  place.push_back(0);
  place.push_back(1);
  return place;
}

bool FluxGrid::is_largest(const FluxPlace& place) const {
  return std::ranges::any_of(place | std::views::take(static_cast<std::ptrdiff_t>(fluxes)),
                             [&](int strength) { return rms_W[static_cast<std::size_t>(strength)] == rms_W.back(); });
}

void FluxGrid::align() {
  constexpr int kPoints = 8;
  const auto nearest = [](double heat_W) { return static_cast<int>(std::lround(std::log(heat_W) / std::log(kStep_ratio))); };
  const int top = nearest(rms_W.back() / kLargest_ratio) + 2;
  rms_W.clear();
  for (int power = top - kPoints + 1; power <= top; ++power) {
    rms_W.push_back(std::pow(kStep_ratio, power));
  }
}

void FluxGrid::reach(double most_W) {
  while (kStep_ratio * rms_W.back() < most_W) {
    rms_W.push_back(kStep_ratio * rms_W.back());
  }
  for (double& each_W : rms_W) {
    each_W = std::min(each_W, most_W);
  }
}

std::vector<FluxPlace> FluxGrid::all_over() const {
  std::vector<FluxPlace> all;
  for (const int strength : {1, 3, 5}) {
    for (const int time_scale : {1, 3}) {
      for (const auto& [size, drift_time_scale] : {std::pair{0, 1}, {1, 1}, {2, 1}, {3, 1}, {2, 2}, {3, 2}}) {
        FluxPlace place(fluxes, strength);
        place.insert(place.end(), {time_scale, size, drift_time_scale});
        all.push_back(std::move(place));
      }
    }
  }
  return all;
}

std::vector<FluxPlace> FluxGrid::star(const FluxPlace& place) const {
  std::vector<std::size_t> counts(fluxes, rms_W.size());
  counts.push_back(time_scale_s.size());
  counts.push_back(drift_K.size());
  counts.push_back(place[fluxes + 1] > 0 ? drift_time_scale_s.size() : 0);
  std::vector<FluxPlace> all{place};
  for (std::size_t axis = 0; axis < counts.size(); ++axis) {
    for (const int step : {-1, 1}) {
      FluxPlace other = place;
      other[axis] += step;
      if (other[axis] >= 0 && other[axis] < static_cast<int>(counts[axis])) {
        all.push_back(std::move(other));
      }
    }
  }
  return all;
}

FluxGrid flux_grid(double material_W, double travel_K, std::size_t fluxes, std::vector<double> least_W) {
  FluxGrid grid;
  grid.fluxes = fluxes;
  for (const double share : {0.02, 0.12, 0.3, 0.7, 1.6, 3.6, kLargest_ratio}) {
    grid.rms_W.push_back(share * material_W);
  }
  for (const double share : {0.0, 0.003, 0.01, 0.03}) {
    grid.drift_K.push_back(share * travel_K);
  }
  grid.drift_time_scale_s = {10.0, 40.0, 160.0};
  // Unknown heat that is certain to exist varies over minutes; a faster one would average out.
  grid.time_scale_s = least_W.empty() ? std::vector{40.0, 130.0, 400.0, 1200.0} : std::vector{160.0, 400.0, 1200.0, 3600.0};
  grid.least_W = std::move(least_W);
  return grid;
}

FluxPlace most_probable(const FluxGrid& grid, FluxPlace start, const std::function<double(const FluxPlace&)>& nats) {
  std::map<FluxPlace, double> known;
  const auto at = [&](const FluxPlace& place) {
    const auto found = known.find(place);
    return found != known.end() ? found->second : known[place] = nats(place);
  };
  for (bool moved = true; moved;) {
    moved = false;
    for (const FluxPlace& other : grid.star(start)) {
      if (at(other) > at(start)) {
        start = other;
        moved = true;
      }
    }
  }
  return start;
}

}  // namespace heatsoak::estimation
