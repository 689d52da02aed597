// How much unknown heat there is: the most probable flux, and others around it with their weights.
#pragma once

#include <functional>
#include <vector>

#include "identify/whitening.h"

namespace heatsoak {

struct FluxRange {
  double unit_W = 1.0;       ///< mean heat of the runs: sizes are sought from 1/1000 of it, which is as good as none, to twice it
  double shortest_s = 10.0;  ///< of the time scale
  double longest_s = 3000.0;
  std::size_t count = 2;  ///< of fluxes
};

/// The logarithm of the evidence, for many fluxes at once so that they can run side by side.
using FluxEvidence = std::function<std::vector<double>(const std::vector<LatentFlux>&)>;

/// Ascent on a lattice of logarithms, first coarse, then fine, then a parabola through the finest. From `start`, or from the
/// lattice's middle where it has no sizes.
LatentFlux most_probable_flux(const FluxEvidence& evidence, const FluxRange& range, const LatentFlux& start);

struct WeightedFlux {
  LatentFlux flux;
  double weight = 0.0;  ///< of the integral over the hypotheses; their sum is 1
};

/// Points and weights that stand for the evidence around its maximum: a central composite design in the directions of its curvature
/// (Rue, Martino and Chopin 2009, section 6.5).
std::vector<WeightedFlux> hypotheses_around(const FluxEvidence& evidence, const FluxRange& range, const LatentFlux& best);

}  // namespace heatsoak
