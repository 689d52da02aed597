// Suppositions about the unknown heat: strengths at the nodes and a time scale, on a lattice.
#pragma once

#include <functional>
#include <vector>

#include "identify/whitening.h"

namespace heatsoak {

/// One place per node that unknown heat may reach, then that of the time scale.
using FluxPlace = std::vector<int>;

struct FluxGrid {
  std::vector<double> rms_W;         ///< increasing
  std::vector<double> time_scale_s;  ///< increasing
  std::size_t fluxes = 2;

  [[nodiscard]] LatentFlux at(const FluxPlace& place) const;
  [[nodiscard]] FluxPlace middle() const;
  /// The place and its neighbours on each axis.
  [[nodiscard]] std::vector<FluxPlace> star(const FluxPlace& place) const;
};

/// Six strengths from hardly any to far more than what matters (`material_W`), four times.
FluxGrid flux_grid(double material_W, std::size_t fluxes);

/// Ascent from `start` to a place that no neighbour exceeds.
FluxPlace most_probable(const FluxGrid& grid, FluxPlace start, const std::function<double(const FluxPlace&)>& nats);

}  // namespace heatsoak
