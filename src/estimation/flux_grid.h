// Grid of assumed statistics of the unknown heat: RMS per node, correlation time, and drift of the sensors.
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "estimation/measured_run.h"
#include "estimation/whitening.h"

namespace heatsoak::estimation {

/// Point of the grid, as indices. First one RMS per node with unknown heat, then the correlation time. The last two are the size of the
/// sensor drift and its correlation time.
using FluxPlace = std::vector<int>;

struct FluxGrid {
  std::vector<double> rms_W;         ///< ascending
  std::vector<double> time_scale_s;  ///< ascending
  std::vector<double> drift_K;       ///< ascending, the first is 0
  std::vector<double> drift_time_scale_s;
  std::size_t fluxes = 2;
  std::vector<double> least_W = {};  ///< per flux, lower limit of its RMS, for heat that exists at unknown times; empty: none

  /// Returns the statistics at a grid point.
  [[nodiscard]] LatentFlux at(const FluxPlace& place) const;
  [[nodiscard]] FluxPlace middle() const;
  /// True if an RMS is the largest of the grid.
  [[nodiscard]] bool is_largest(const FluxPlace& place) const;
  /// Extends the RMS values up to about `most_W`, and lowers larger ones to it.
  void reach(double most_W);
  /// Replaces the RMS values by powers of one ratio, up to about the largest. The points then hardly depend on the start values of the
  /// model, and neither does the answer. Only for three recordings or more: from one short log, a correct name was lost.
  void align();
  /// Returns points spread over the whole grid, so that a search does not stop at one local optimum.
  [[nodiscard]] std::vector<FluxPlace> all_over() const;
  /// Returns the point and its neighbours on each axis. Without drift, the axis of the drift's correlation time is left out.
  [[nodiscard]] std::vector<FluxPlace> star(const FluxPlace& place) const;
};

/// Returns the heat in W that warms the outermost body by `rise_K` in the steady state, as a mean over the runs.
double material_heat_W(const std::vector<LinearisedRun>& runs, double rise_K);
/// Returns the range of the readings in K, RMS over all sensors and runs.
double travel_K(std::span<const MeasuredRun> runs);

/// Returns a grid of seven RMS values (0.02 to 8 times `material_W`), four correlation times, four drift sizes (0 to 3 % of `travel_K`) and
/// three drift correlation times. `material_W`: unknown heat that matters. `travel_K`: RMS over the sensors of the range of their readings.
/// `least_W` as in FluxGrid; with it the correlation times are longer.
FluxGrid flux_grid(double material_W, double travel_K, std::size_t fluxes, std::vector<double> least_W = {});

/// Climbs from `start` to a point where no neighbour has a larger value of `nats`. Evaluates each point at most once.
FluxPlace most_probable(const FluxGrid& grid, FluxPlace start, const std::function<double(const FluxPlace&)>& nats);

}  // namespace heatsoak::estimation
