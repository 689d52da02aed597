// Adds terms to a model, and transfers parameter values between models.
#pragma once

#include <optional>
#include <string_view>

#include "attribution/candidates.h"
#include "attribution/regressor_scan.h"

namespace heatsoak::attribution {

/// State of the exponents, thresholds and capacities of an added effect: fitted or fixed.
enum class ShapesAre { free, held };

/// Returns the model with the candidate added and its size free, starting at `size_share` typical sizes, clamped to the allowed range.
estimation::Model with_candidate(const estimation::Model& model, const Candidate& candidate, double size_share,
                                 ShapesAre shapes = ShapesAre::free);

/// Returns the coordinate of the candidate's size. The model must contain it as an effect of that name, a sensor error or a run deviation.
Eigen::Index size_coordinate(const estimation::Model& model, const Candidate& candidate, std::string_view effect_name);

/// Returns the model with the curve added as an effect `tabulated` with free values; negative ones are 0, and a conductance starts at 0.
/// Returns nothing if an effect cannot depend on this signal, or if the model already uses another log column.
std::optional<estimation::Model> with_curve(const estimation::Model& model, const ScanResult& curve, const Regressor& regressor);

/// Returns `model` with the values of parameters, sensor errors and deviations that `other` also contains.
estimation::Model with_values_of(estimation::Model model, const estimation::Model& other);

}  // namespace heatsoak::attribution
