// Intervals where the curvature at the optimum says too little: the profile likelihood.
#pragma once

#include <Eigen/Core>
#include <utility>

#include "identify/fit.h"

namespace heatsoak {

/// The interval of θ in which the penalised misfit, minimised over everything else, stays within 1.92 of its minimum (95 %), for the flux
/// and noise of the fit. An end that is not reached before the parameter's bounds is the bound.
std::pair<double, double> profile_interval(const Model& model, std::span<const MeasuredRun> runs, const Fit& fit, int parameter,
                                           int threads);

}  // namespace heatsoak
