// Estimates the unmodelled part of the measurements: the most probable unknown heat flux and sensor drift, and weighted alternatives
// around that maximum.
#pragma once

#include <functional>
#include <vector>

#include "estimation/whitening.h"

namespace heatsoak::estimation {

/// One setting of the unmodelled part: unknown heat flux at the nodes and drift of the sensors.
struct Supposition {
  LatentFlux flux;
  std::vector<double> drift_K;  ///< standard deviation of the drift per kind of sensor; empty: no drift
  double drift_time_scale_s = 10.0;
};

/// Largest unknown heat as a fraction of the mean heat. With more than this even a wrong model would fit, and its parameters would mean
/// nothing.
inline constexpr double kMostFlux_share = 0.2;

struct SuppositionRange {
  double unit_W = 1.0;       ///< mean heat of the runs; the search starts at 1/1000 of it, which is negligible
  double shortest_s = 10.0;  ///< lower limit of the flux's time scale
  double longest_s = 3000.0;
  std::size_t fluxes = 2;
  std::vector<double> least_W;       ///< per flux: lower limit of its RMS, for heat that is certain to exist; empty: none
  std::vector<double> drift_unit_K;  ///< per kind of sensor: range of its readings; the drift is searched from 1/10000 to 1/5 of it
  double drift_shortest_s = 4.0;
  double drift_longest_s = 100.0;
};

/// Returns the log evidence in nats of each supposition. Takes many at once so that they can be evaluated in parallel.
using Evidence = std::function<std::vector<double>(const std::vector<Supposition>&)>;

/// Returns the supposition with the largest evidence. Climbs on a lattice of logarithms, first coarse, then fine, and finally fits a
/// parabola. Begins at `start`, or at default sizes if `start` has no flux. The result has sensor drift only if `start` has.
Supposition most_probable(const Evidence& evidence, const SuppositionRange& range, const Supposition& start);
/// Returns `start` with sensor drift of a hundredth of the range of the readings, and with each flux limited to 2 % of the mean heat.
Supposition with_drift(const SuppositionRange& range, const Supposition& start);

struct WeightedSupposition {
  Supposition supposition;
  double weight = 0.0;  ///< share of the posterior probability; the sum of all weights is 1
};

/// Returns points and weights that approximate the evidence around its maximum `best`: a central composite design along the principal
/// axes of its curvature (Rue, Martino and Chopin 2009, section 6.5).
std::vector<WeightedSupposition> suppositions_around(const Evidence& evidence, const SuppositionRange& range, const Supposition& best);

}  // namespace heatsoak::estimation
