// Usual load of measured runs: the mean heat of a model, and a large current.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "estimation/measured_run.h"
#include "estimation/model.h"

namespace heatsoak::estimation {

/// Returns the mean over time of the heat in W that the model generates or dissipates, whichever is larger, at the measured temperatures.
/// It is the unit of the unknown heat. Nodes without a sensor keep the temperature of `start_C`.
double usual_heat_W(const Model& model, std::span<const MeasuredRun> runs, const std::vector<std::vector<double>>& start_C);

/// Returns the 98th percentile of the RMS current in A over the intervals with current; empty if there are none.
std::optional<double> large_current_A(std::span<const MeasuredRun> runs);

}  // namespace heatsoak::estimation
