// How much there is that the model does not know: the most probable flux and wander of the sensors, and others around with their weights.
#pragma once

#include <functional>
#include <vector>

#include "identify/whitening.h"

namespace heatsoak {

/// One supposition about what is not known: heat at the nodes, slow errors of the sensors.
struct Supposition {
  LatentFlux flux;
  std::vector<double> wander_K;  ///< per kind of sensor; empty: none wanders
  double wander_time_scale_s = 10.0;
};

/// Of the mean heat. With more than this granted a model that is wrong at every turn would still fit, and its figures say nothing.
inline constexpr double kMostFlux_share = 0.2;

struct SuppositionRange {
  double unit_W = 1.0;       ///< mean heat of the runs: sizes are sought from 1/1000 of it, which is as good as none
  double shortest_s = 10.0;  ///< of the flux's time scale
  double longest_s = 3000.0;
  std::size_t fluxes = 2;
  std::vector<double> least_W;        ///< per flux: rms that there is for certain; empty: none
  std::vector<double> wander_unit_K;  ///< per kind of sensor: how far temperatures move; sizes are sought from 1/10000 of it to 1/5
  double wander_shortest_s = 4.0;
  double wander_longest_s = 100.0;
};

/// The logarithm of the evidence, for many suppositions at once so that they can run side by side.
using Evidence = std::function<std::vector<double>(const std::vector<Supposition>&)>;

/// Ascent on a lattice of logarithms, first coarse, then fine, then a parabola through the finest. From `start`, or from the
/// lattice's middle where it has no sizes. Sensors wander in the answer where they do in the start.
Supposition most_probable(const Evidence& evidence, const SuppositionRange& range, const Supposition& start);
/// With sensors that wander by a hundredth of how far temperatures move, and no more heat than `start` has.
Supposition with_wander(const SuppositionRange& range, const Supposition& start);

struct WeightedSupposition {
  Supposition supposition;
  double weight = 0.0;  ///< of the integral over the suppositions; their sum is 1
};

/// Points and weights that stand for the evidence around its maximum: a central composite design in the directions of its curvature
/// (Rue, Martino and Chopin 2009, section 6.5).
std::vector<WeightedSupposition> suppositions_around(const Evidence& evidence, const SuppositionRange& range, const Supposition& best);

}  // namespace heatsoak
