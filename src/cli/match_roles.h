// JSON of a match played in every role.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "duty/match/roles.h"

namespace heatsoak {

nlohmann::ordered_json role_json(const RoleLoads& roles);

}  // namespace heatsoak
