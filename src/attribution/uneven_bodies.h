// A body of the network is not of one temperature, and its sensor sits somewhere in it.
#pragma once

#include <vector>

#include "estimation/linearised_run.h"

namespace heatsoak {

/// How much of the difference to a neighbour a sensor may show, standard deviation: a fifth of a per cent, far below a Biot number of 0.1
/// up to which bodies are taken as lumped at all (F. P. Incropera et al., Fundamentals of Heat and Mass Transfer, 7th edition,
/// section 5.1).
inline constexpr double kUneven_share = 0.002;

/// Per run one column per sensor and other body, in K per share of their difference: the same columns in every run.
std::vector<Columns> uneven_bodies(const std::vector<LinearisedRun>& fitted, const std::vector<MeasuredRun>& runs);

}  // namespace heatsoak
