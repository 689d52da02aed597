// Where the states of a run most probably were, given all readings and an unknown heat.
#pragma once

#include <Eigen/Core>

#include "identify/whitening.h"

namespace heatsoak {

/// States × samples in °C: the run's own path, corrected by the start temperatures and the unknown heat that are most probable.
Eigen::MatrixXd smoothed_path_C(const LinearisedRun& run, const LatentFlux& flux, const SensorNoise& noise);

}  // namespace heatsoak
