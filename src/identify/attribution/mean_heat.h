// What the size and the length of things are measured by.
#pragma once

#include <vector>

#include "identify/measured_run.h"
#include "identify/model.h"

namespace heatsoak {

/// Mean over time of the heat in W that the model's sources make, at the first measured temperatures.
double mean_heat_W(const Model& model, const std::vector<MeasuredRun>& runs);
double longest_s(const std::vector<MeasuredRun>& runs);

}  // namespace heatsoak
