// Heat that the model knows of, and what the size and the length of things are measured by.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "attribution/refit.h"

namespace heatsoak {

/// Mean over time of the heat in W that the model's sources make, at the first measured temperatures.
double mean_heat_W(const Model& model, const std::vector<MeasuredRun>& runs);
double longest_s(const std::vector<MeasuredRun>& runs);

/// Heat of every effect in every node (effects × nodes, W) over one interval of a run.
using HeatVisit = std::function<void(std::size_t interval, std::span<const double> heat_W)>;

/// Visits the intervals of a run along the path that a fit has taken.
void heat_along(const RefitResult& fit, const MeasuredRun& run, const LinearisedRun& path, const HeatVisit& visit);

struct HeatOfEffect {
  double mean_W = 0.0;
  double peak_W = 0.0;  ///< 99 % of the samples have less
};
/// Size of the heat into the first node of those effects of the fitted network that `counts` says, in runs of the condition.
HeatOfEffect heat_of(const RefitResult& fit, const std::vector<MeasuredRun>& runs, const std::function<bool(const EffectInPlace&)>& counts,
                     const Condition& condition);

}  // namespace heatsoak
