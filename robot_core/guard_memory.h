// Temperatures of the thermal guards over a loss of power: from a copy of the State that outlived it, in backup RAM or flash.
//
//   once, while the robot stands:  start(config, state, {});  restore_guards(config, state, copy.guard, elapsed_s, board_C);
//   after each step:               copy the State to the backup RAM
//
// step() and start() need nothing of this file, so a controller without a memory does not carry it.
#pragma once

#include "robot_core/drive_core.h"

namespace robot_core {

enum class Restored {
  cooled,        ///< for the time that has passed
  time_unknown,  ///< time without power unknown: each node takes its highest safe temperature
  nothing        ///< the copy fails its check sum or holds no temperatures: as hot as the limit
};

/// Sets `state` to `saved`, cooled for `elapsed_s` without current in the hottest air; a negative time or one that is not a number is
/// unknown, and every node is then as hot as it was or may have become from the heat of the others. No node is colder than `board_C`, and
/// a board without a temperature counts as the hottest air. At most kMostCoolingSteps evaluations of the law and a few more.
Restored restore_guard(const GuardModel& model, GuardState& state, const GuardState& saved, float elapsed_s, float board_C);

inline constexpr int kMostCoolingSteps = 4096;

/// After start() with the same Config: all guards from those of an earlier State. Wheels without a valid copy stay as hot as their limit.
/// False if a wheel stays so.
bool restore_guards(const Config& config, State& state, const GuardState* saved, float elapsed_s, float board_C);

}  // namespace robot_core
