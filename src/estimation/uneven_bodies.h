// Sensor errors from temperature differences within a body: a reading depends on where the sensor is.
#pragma once

#include <vector>

#include "estimation/linearised_run.h"

namespace heatsoak::estimation {

/// Prior standard deviation of a sensor's error, as a fraction of the temperature difference to another body. It is far below the Biot
/// number of 0.1 up to which a body may be lumped (F. P. Incropera et al., Fundamentals of Heat and Mass Transfer, 7th edition, section
/// 5.1).
inline constexpr double kUneven_share = 0.002;

/// Returns, per run, one column per sensor and body: the temperature difference in K between that body and the sensor's own. All runs have
/// the same columns.
std::vector<Columns> uneven_bodies(const std::vector<LinearisedRun>& fitted, const std::vector<MeasuredRun>& runs);

}  // namespace heatsoak::estimation
