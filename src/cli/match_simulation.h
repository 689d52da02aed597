// `simulate` for a match: the closed loop as answer, JSON, CSV and picture, for one planner or for both.
#pragma once

#include <string>
#include <vector>

#include "cli/command.h"
#include "simulate/guarded_core.h"
#include "simulate/match_run.h"

namespace heatsoak {

struct MatchSimulation {
  const Robot& robot;
  const Motor& motor;
  const Duty& duty;
  const MatchInputs& inputs;
  std::vector<Planner> planners;
  std::uint64_t seed = 1;
  std::string out;   ///< CSV file; for one planner only
  std::string plot;  ///< SVG file
  double every_s = 1.0;
  GuardUse guard = GuardUse::shadow;
  bool is_sensing_ideal = false;
};

ExitCode simulate_match(const MatchSimulation& wanted, Session& session);

}  // namespace heatsoak
