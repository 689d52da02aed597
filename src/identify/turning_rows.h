// Rows in which a motor turns round: the mean of a speed with its sign is less than what bearings and iron feel.
#pragma once

#include <string_view>

#include "identify/measured_run.h"

namespace heatsoak {

/// Some row's speed may hide that the motor turned round in it: it or a neighbour turns the other way.
bool may_turn_within_rows(const MeasuredRun& run);

/// The run as it was if the speed of such rows went straight from near the row before through their mean to near the row behind, where
/// the log as it stands says that it was held. Rows that are means of finer ones know better and stay.
MeasuredRun turning_within_rows(MeasuredRun run);

inline constexpr std::string_view kTurningRowsTold =
    "speed changes its sign from row to row: what it was in between is taken for a straight line, which these runs find more probable than "
    "a speed that was held over its row";

}  // namespace heatsoak
