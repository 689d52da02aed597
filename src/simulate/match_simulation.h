// Answer of `simulate` for a match: one game in closed loop, driven once with each planner.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/job_progress.h"
#include "select/evaluate.h"
#include "simulate/guarded_core.h"
#include "simulate/match_run.h"
#include "simulate/match_trace.h"

namespace heatsoak::simulate {

struct MatchJob {
  robot::Robot robot;
  motor::Motor motor;
  duty::Duty duty;  ///< a match
  std::vector<duty::Planner> planners{duty::Planner::jerk_limited};
  std::uint64_t seed = 1;  ///< seed of game, sensors and radio
  GuardUse guard = GuardUse::shadow;
  bool is_sensing_ideal = false;
  bool with_table = false;  ///< make the CSV; for one planner only
  double every_s = 1.0;     ///< time between two rows of the CSV
  bool with_rows = false;   ///< keep rows for a chart
};

struct DrivenMatch {
  duty::Planner planner = duty::Planner::jerk_limited;
  MatchRun run;
  /// fail: a limit is exceeded; infeasible: drive_problem(); marginal: fail or infeasible only in `upper`
  select::Verdict verdict = select::Verdict::pass;
  std::optional<DriveScore> upper = {};  ///< the same game with motor::at_upper_band(); empty without a band
  std::string csv;
  std::vector<MatchRow> rows;  ///< one row every kMatchRow_s
};
inline constexpr double kMatchRow_s = 2.0;

struct MatchSimulation {
  robot::Robot robot;  ///< robot with assumed friction if its file has none
  motor::Motor motor;
  duty::Duty duty;
  duty::Role role = duty::Role::attacker;
  std::uint64_t seed = 1;
  GuardUse guard_use = GuardUse::shadow;
  MotorGuard guard;  ///< empty if guard_use is off
  bool is_sensing_ideal = false;
  std::vector<DrivenMatch> runs;  ///< one for each planner

  /// Returns the run that decides the verdict: the first that fails (a limit exceeded), else the first that is infeasible (not driven),
  /// else the first that is marginal, else the first.
  [[nodiscard]] const DrivenMatch& deciding() const;
  /// Returns the verdict of deciding().
  [[nodiscard]] select::Verdict verdict() const;
};

/// Simulates the match. Throws Failure (bad_input) if the files of robot or motor lack values for motion, or if the CSV would be too large.
MatchSimulation simulate_match(const MatchJob& job, const base::JobProgress& progress = {});

}  // namespace heatsoak::simulate
