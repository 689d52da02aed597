// Answer of `duty`: the demand of a robot's wheels from a generated match, a prescribed load or a recorded game.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>

#include "base/job_progress.h"
#include "duty/duty.h"
#include "duty/duty_rows.h"
#include "duty/game_to_demand.h"
#include "duty/match/roles.h"
#include "robot/robot.h"

namespace heatsoak::duty {

struct DutyJob {
  robot::Robot robot;
  std::optional<Duty> duty = {};  ///< empty: the recorded game `log` is used
  std::string log = {};
  std::string player = {};                 ///< name in the recorded game, for example "yellow 3"; empty: the robot with the largest ∫a²
  double every_s = 0.01;                   ///< time between two rows of the table
  std::optional<std::uint64_t> seed = {};  ///< seed of a match; 1 if empty
  std::optional<Planner> planner = {};     ///< planner of a match; jerk_limited if empty
  DutyRows::Put put_table = {};            ///< gets the text of the table as it is made; empty: no table
};

struct PrescribedLoad {
  double duration_s = 0.0;
};

struct GeneratedMatch {
  Role role;
  std::uint64_t seed = 1;
  MatchLoad load;
  RoleLoads roles;  ///< the same game in every role
};

struct DutyAnswer {
  robot::Robot robot;
  std::optional<Duty> duty;  ///< empty for a recorded game
  std::string log;           ///< file of a recorded game
  std::variant<PrescribedLoad, GeneratedMatch, GameDemand> content;
};

/// Computes the demand. Throws Failure: bad_input if seed or planner is given for a duty that is not a match; GameNotUsable if the player
/// is unknown or no robot of a recorded game is seen long enough.
DutyAnswer make_duty(const DutyJob& job, const base::JobProgress& progress = {});

/// Returns the duty file that describes the table `csv` beside it, so that `evaluate --duty FILE.toml` can read it.
std::string duty_file(const DutyAnswer& answer, const std::filesystem::path& csv);

}  // namespace heatsoak::duty
