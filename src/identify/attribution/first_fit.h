// A model near its fit brought to the runs, before anything is looked for.
#pragma once

#include <vector>

#include "identify/attribution/refit.h"

namespace heatsoak {

struct FirstFit {
  double mean_heat_W = 0.0;  ///< that the model knows of, over all runs
  FluxGrid::Place place;     ///< where a search for the unknown heat begins that knows nothing yet
  RefitOptions options;      ///< that all further fits of these runs are compared under
  RefitResult fit;
};

FirstFit first_fit(const ExtendedModel& model, const std::vector<MeasuredRun>& runs);

}  // namespace heatsoak
