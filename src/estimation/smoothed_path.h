// Most probable node temperatures and unknown heat of a run, given all readings.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "estimation/posterior.h"

namespace heatsoak::estimation {

/// Returns the path (states × samples, in °C): the simulated path plus the effect of the most probable start temperatures and heat flux.
Eigen::MatrixXd smoothed_path_C(const LinearisedRun& run, const LatentFlux& flux, const SensorNoise& noise);

/// Returns the unknown heat of every run of a fit. `weights` and `merged` as in design().
std::vector<FluxEstimate> smoothed_flux(const Posterior& fit, const std::vector<MeasuredRun>& runs,
                                        const std::vector<Eigen::VectorXd>& weights, const std::vector<int>& merged);
/// Returns the RMS over all runs of each flux in W.
Eigen::VectorXd rms_W(const std::vector<FluxEstimate>& runs);

}  // namespace heatsoak::estimation
