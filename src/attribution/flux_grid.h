// Suppositions about the unknown heat: strengths at the nodes and a time scale, on a lattice.
#pragma once

#include <functional>
#include <vector>

#include "estimation/whitening.h"

namespace heatsoak {

/// One place per node that unknown heat may reach, then those of its time scale, and of size and time scale of the slow
/// error of all sensors.
using FluxPlace = std::vector<int>;

struct FluxGrid {
  std::vector<double> rms_W;         ///< increasing
  std::vector<double> time_scale_s;  ///< increasing
  std::vector<double> drift_K;       ///< increasing, first 0
  std::vector<double> drift_time_scale_s;
  std::size_t fluxes = 2;

  [[nodiscard]] LatentFlux at(const FluxPlace& place) const;
  [[nodiscard]] FluxPlace middle() const;
  /// Places all over the lattice, for a search that must not begin beside one optimum.
  [[nodiscard]] std::vector<FluxPlace> all_over() const;
  /// The place and its neighbours on each axis; without a slow error it has no time scale.
  [[nodiscard]] std::vector<FluxPlace> star(const FluxPlace& place) const;
};

/// Six strengths from hardly any to far more than what matters (`material_W`), four times.
/// `travel_K`: rms of how far the measured temperatures move.
FluxGrid flux_grid(double material_W, double travel_K, std::size_t fluxes);

/// Ascent from `start` to a place that no neighbour exceeds.
FluxPlace most_probable(const FluxGrid& grid, FluxPlace start, const std::function<double(const FluxPlace&)>& nats);

}  // namespace heatsoak
