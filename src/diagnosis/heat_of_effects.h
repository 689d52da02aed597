// Mean and peak of the heat that a fitted model assigns to its effects.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "estimation/posterior.h"

namespace heatsoak::diagnosis {

/// Heat of every effect in every node (effects × nodes, W) over one interval of a run.
using HeatVisit = std::function<void(std::size_t interval, std::span<const double> heat_W)>;

/// Calls `visit` for each interval of a run, with the temperatures of `path` at its start.
void heat_along(const estimation::Posterior& fit, const estimation::MeasuredRun& run, const estimation::LinearisedRun& path,
                const HeatVisit& visit);

struct HeatOfEffect {
  double mean_W = 0.0;
  double peak_W = 0.0;  ///< 99th percentile of the magnitude
};
/// Returns mean and peak magnitude of the heat into the first node of all effects that `counts` accepts, over the runs with the condition.
/// 0 if no run has it.
HeatOfEffect heat_of(const estimation::Posterior& fit, const std::vector<estimation::MeasuredRun>& runs,
                     const std::function<bool(const thermal::EffectInPlace&)>& counts, const estimation::Condition& condition);

}  // namespace heatsoak::diagnosis
