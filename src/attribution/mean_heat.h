// Mean and peak of the modelled heat.
#pragma once

#include <vector>

#include "estimation/model.h"

namespace heatsoak::attribution {

/// Returns the time average of the modelled source heat in W, evaluated at the start temperatures. Flows between nodes do not count. 0
/// without data.
double mean_heat_W(const estimation::Model& model, const std::vector<estimation::MeasuredRun>& runs);

}  // namespace heatsoak::attribution
