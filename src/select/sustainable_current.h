// Finds the factor on all currents at which a node just reaches its limit.
#pragma once

#include <optional>
#include <span>

#include "thermal/network.h"
#include "thermal/transient.h"

namespace heatsoak::select {

/// Returns the factor on all currents, at unchanged speeds, at which the first node just reaches its limit. Each round simulates eight
/// factors and continues between the two that enclose the result; the last round interpolates linearly. Returns nothing if a limit is
/// exceeded without any current, or if no current reaches a limit. `is_too_much`: the present currents exceed a limit, so the search begins
/// with factors up to 1.
std::optional<double> sustainable_current_factor(const thermal::Network& network, std::span<const thermal::Interval> intervals,
                                                 std::span<const thermal::NodeLimit> limits, bool is_too_much);

}  // namespace heatsoak::select
