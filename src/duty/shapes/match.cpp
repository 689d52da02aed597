#include "duty/duty.h"
#include "duty/match/match_duty.h"

namespace heatsoak::duty::shapes {
namespace {

void read_match(input::Reader& table, const std::filesystem::path& /*folder*/, Duty& duty) {
  duty.kind = DutyKind::torque;
  duty.shape_data = std::make_shared<MatchDuty>(read_match_inputs(table));
}

}  // namespace

ShapeType match() {
  return {.name = {},
          .summary = "a synthetic game by the rules: phases, a role's targets and duels, through the planner and the robot's dynamics",
          .example = R"(shape = "match"
[match]
division = "A"
role = "attacker"   # or "defender", "keeper"
# and the named inputs of duty_profiles/division_a_match.toml, each with its range
)",
          .read = read_match};
}

}  // namespace heatsoak::duty::shapes
