// A model with one term more, or one less.
#pragma once

#include <optional>
#include <string_view>

#include "attribution/extended_model.h"
#include "attribution/regressor_scan.h"

namespace heatsoak {

/// Exponents, thresholds and capacities that come with an effect.
enum class ShapesAre { free, held };

/// The candidate in place with its size free, beginning at `size_share` typical sizes. Without a `name` it gets one that is not used.
ExtendedModel with_candidate(const ExtendedModel& model, const Candidate& candidate, double size_share, std::string_view name = {},
                             ShapesAre shapes = ShapesAre::free);

/// The coordinate of the candidate's size in a model that has it: as an effect of that name, or a fault of a sensor, or a run's deviation.
Eigen::Index size_coordinate(const ExtendedModel& model, const Candidate& candidate, std::string_view effect_name);

/// The curve as an effect of the network, its values free: a table over the driver, or a conductance or source in certain runs only.
/// What physics forbids (a loss below zero) is cut off; nothing where no operating point has the driver, or nothing would be left.
std::optional<ExtendedModel> with_curve(const ExtendedModel& model, const ScanResult& curve, const Regressor& driver,
                                        std::string_view name = {});

/// `model` with the values that parameters and sensors of the same name have in `other`.
ExtendedModel with_values_of(ExtendedModel model, const ExtendedModel& other);
/// One of the figures that both have is off by a factor of two or more: from there not every step leads back.
bool has_strayed(const ExtendedModel& model, const ExtendedModel& from);

}  // namespace heatsoak
