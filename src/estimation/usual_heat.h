// Mean heat of a model along measured runs.
#pragma once

#include <span>
#include <vector>

#include "estimation/measured_run.h"
#include "estimation/model.h"

namespace heatsoak::estimation {

/// Returns the mean over time of the heat in W that the model generates or dissipates, whichever is larger, at the measured temperatures.
/// It is the unit of the unknown heat. Nodes without a sensor keep the temperature of `start_C`.
double usual_heat_W(const Model& model, std::span<const MeasuredRun> runs, const std::vector<std::vector<double>>& start_C);

}  // namespace heatsoak::estimation
