// Sensor errors from temperature differences within a body: a reading depends on where the sensor is.
#pragma once

#include <vector>

#include "estimation/linearised_run.h"

namespace heatsoak {

/// Returns, per run, one column per sensor and body: the temperature difference in K between that body and the sensor's own. All runs have
/// the same columns.
std::vector<Columns> uneven_bodies(const std::vector<LinearisedRun>& fitted, const std::vector<MeasuredRun>& runs);

}  // namespace heatsoak
