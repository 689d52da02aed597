// Plays one match in every role, and sums its torque by phase and duel.
#pragma once

#include <array>

#include "base/parallel.h"
#include "duty/match/generator.h"

namespace heatsoak::duty {

/// Loads of one game, one per role in the order of kRoleNames.
using RoleLoads = std::array<MatchLoad, kRoleNames.size()>;
/// Plays the game of `seed` once in each role.
RoleLoads play_roles(const MatchInputs& inputs, const robot::Robot& robot, std::uint64_t seed, Planner planner,
                     const base::Progress& progress = {});

/// Returns ∫M²dt summed over all wheels. It is proportional to the copper heat of motors without drag.
double effort_Nm2_s(const PhaseLoad& phase);
double effort_Nm2_s(const MatchLoad& load);

/// Returns ∫M²dt in duels, summed over all wheels.
double duel_effort_Nm2_s(const MatchLoad& load);

/// Returns the largest effort_Nm2_s() of the roles.
double most_effort_Nm2_s(const RoleLoads& roles);

/// Returns the RMS torque over all wheels and the whole match.
double torque_rms_Nm(const MatchLoad& load);

/// Returns the time spent in duels.
double duel_s(const MatchLoad& load);

}  // namespace heatsoak::duty
