// Documents of `duty`.
#pragma once

#include <cstdint>
#include <string>

#include "duty/duty.h"
#include "duty/game_to_demand.h"
#include "duty/match/roles.h"
#include "present/document.h"
#include "robot/robot.h"

namespace heatsoak::present {

/// Describes a duty that is not a match; `duration_s` is its length.
Document load_document(const Duty& duty, double duration_s);

/// Describes a generated match: where its heat comes from, by phase and by role.
Document match_duty_document(const Duty& duty, const Robot& robot, std::string_view role, std::uint64_t seed, const MatchLoad& load,
                             const RoleLoads& roles);

/// Describes the demand taken from a recorded game.
Document recorded_game_document(const GameDemand& game, const Robot& robot, const std::string& log);

/// Adds the names of the written table and its duty file, and the command that evaluates them.
void add_duty_files(Document& document, const std::string& table, const std::string& description);

}  // namespace heatsoak::present
