// JSON of a match played in every role.
#pragma once

#include "duty/match/roles.h"
#include "present/json.h"

namespace heatsoak::present {

Json role_json(const duty::RoleLoads& roles);

}  // namespace heatsoak::present
