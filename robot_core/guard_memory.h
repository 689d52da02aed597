// Restores the temperatures of the thermal guards and the list of sensors after a loss of power, from a copy of the State in backup RAM or
// flash.
//
//   once, while the robot stands:  start(config, state, {});  restore(config, state, copy, elapsed_s, board_C);
//   after each step:               copy the State to the backup RAM
//
// step() and start() do not need this file. A controller without such a memory need not contain it.
#pragma once

#include "robot_core/drive_core.h"

namespace robot_core {

enum class Restored {
  cooled,        ///< temperatures cooled for the elapsed time
  time_unknown,  ///< time without power unknown: each node gets the highest temperature that it may have reached
  nothing        ///< the copy fails its check sum or holds no temperatures: each node gets the temperature limit
};

/// Sets `state` to `saved`, cooled for `elapsed_s` without current in the hottest air. A time that is negative, not finite or 1e9 s or more
/// is unknown: each node then gets its highest temperature, heat from the other nodes included. No node is colder than `board_C`; an
/// implausible `board_C` counts as the hottest air. Evaluates the law at most (5 + (nodes + 1)/4)·kMostCoolingSteps times, for each
/// possible age.
Restored restore_guard(const GuardModel& model, GuardState& state, const GuardState& saved, float elapsed_s, float board_C);

inline constexpr int kMostCoolingSteps = 1024;

/// Restores all guards from an earlier State with the same Config, and goes on with their unfinished periods; call it after start(). The
/// guard of a wheel without a valid copy starts at its temperature limit. A copy from firmware with another layout of State is not valid.
/// Returns false if there is such a wheel or no guard. Also restores which sensors are fitted, so that a missing sample of a
/// current, stator or air temperature stays a fault (120, 150, 151).
bool restore(const Config& config, State& state, const State& saved, float elapsed_s, float board_C);

}  // namespace robot_core
