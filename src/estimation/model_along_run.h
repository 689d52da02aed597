// Free-running simulation of a model along a run, with its sensor errors, conditions and run deviations.
#pragma once

#include <span>

#include "estimation/evidence.h"
#include "estimation/linearised_run.h"
#include "estimation/model.h"

namespace heatsoak::estimation {

/// Simulates and linearises the model, its sensor errors included. The columns are per unit of each coordinate. If `start_C` is
/// shorter than the number of state nodes, the other nodes start at ambient temperature.
LinearisedRun linearise(const Model& model, std::span<const double> start_C, const MeasuredRun& run);
/// Linearises the model, its sensor errors included, along a path as linearise_along() of a network does.
LinearisedRun linearise_along(const Model& model, const Eigen::MatrixXd& path_C, const MeasuredRun& run);

}  // namespace heatsoak::estimation
