// Origin of the heat of a match: by phase and by role, with duels listed separately.
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "duty/match/generator.h"

namespace heatsoak {

/// The same game played in each role, in the order of kRoleNames.
using RoleLoads = std::array<MatchLoad, kRoleNames.size()>;
RoleLoads play_roles(const MatchInputs& inputs, const Robot& robot, std::uint64_t seed, Planner planner);

/// Shares of ∫M²dt of the wheels, which do not depend on the motor. The copper heat of a motor also includes the current for its own drag.
std::string role_table(const RoleLoads& roles);
nlohmann::ordered_json role_json(const RoleLoads& roles);

}  // namespace heatsoak
