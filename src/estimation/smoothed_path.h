// Most probable node temperatures of a run, given all readings and an unknown heat flux.
#pragma once

#include <Eigen/Core>

#include "estimation/whitening.h"

namespace heatsoak::estimation {

/// Returns the path (states × samples, in °C): the simulated path plus the effect of the most probable start temperatures and heat flux.
Eigen::MatrixXd smoothed_path_C(const LinearisedRun& run, const LatentFlux& flux, const SensorNoise& noise);

}  // namespace heatsoak::estimation
