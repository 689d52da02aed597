// Mean heat of a model along measured runs.
#pragma once

#include <span>
#include <vector>

#include "estimation/measured_run.h"
#include "estimation/model.h"
#include "estimation/open_loop.h"

namespace heatsoak::estimation {

/// Returns the mean over time of the heat in W that the model generates or dissipates, whichever is larger, at the measured temperatures.
/// It is the unit of the unknown heat. Nodes without a sensor keep the temperature of `starts`.
double usual_heat_W(const Model& model, std::span<const MeasuredRun> runs, const std::vector<RunStart>& starts);

}  // namespace heatsoak::estimation
