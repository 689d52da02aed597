// Where a match's heat comes from: phase by phase, role by role, duels apart.
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "duty/match/generator.h"

namespace heatsoak {

/// The same game as each role plays it, in the order of kRoleNames.
using RoleLoads = std::array<MatchLoad, kRoleNames.size()>;
RoleLoads play_roles(const MatchInputs& inputs, const Robot& robot, std::uint64_t seed, Planner planner);

/// Shares of ∫M²dt of the wheels, whatever motor turns them; copper heat adds what the motor's own drag asks while it turns.
std::string role_table(const RoleLoads& roles);
nlohmann::ordered_json role_json(const RoleLoads& roles);

}  // namespace heatsoak
