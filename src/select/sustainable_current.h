// How much more current a motor bears.
#pragma once

#include <optional>
#include <span>

#include "thermal/network.h"
#include "thermal/transient.h"

namespace heatsoak::select {

/// The factor on all currents, at the same speeds, with which the first node just reaches its limit: eight factors at a time, each
/// round between the two that enclose it, at last by their temperatures. Nothing where even no current is too much, or no current heats.
/// `is_too_much` says that the currents as they are pass a limit, so that no larger ones need to be tried.
std::optional<double> sustainable_current_factor(const thermal::Network& network, std::span<const thermal::Interval> intervals,
                                                 std::span<const thermal::NodeLimit> limits, bool is_too_much);

}  // namespace heatsoak::select
