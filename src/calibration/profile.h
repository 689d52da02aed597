// Confidence intervals from the profile likelihood, for parameters whose likelihood is not a parabola.
#pragma once

#include <Eigen/Core>
#include <utility>

#include "estimation/fit.h"

namespace heatsoak::calibration {

/// Returns the 95 % interval of one component of θ: the cost, minimised over everything else, stays within 1.92 of its minimum. Flux and
/// noise are those of the fit. An end beyond the parameter's bounds is set to the bound.
std::pair<double, double> profile_interval(const estimation::Model& model, const std::vector<estimation::MeasuredRun>& runs,
                                           const estimation::Fit& fit, int parameter);

}  // namespace heatsoak::calibration
