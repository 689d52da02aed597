// Documents of `simulate`: a match in the closed loop, or one motor under a prescribed load.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "present/document.h"
#include "select/evaluate.h"
#include "select/trace.h"
#include "simulate/guarded_core.h"
#include "simulate/match_run.h"

namespace heatsoak {

std::string_view to_string(Planner planner);

}  // namespace heatsoak

namespace heatsoak::present {

/// A match that was driven once for each planner.
struct MatchAnswer {
  const Robot& robot;
  const Motor& motor;
  const Duty& duty;
  Role role;
  std::uint64_t seed = 1;
  GuardUse guard = GuardUse::shadow;
  const MotorGuard& made_guard;
  bool is_sensing_ideal = false;
  std::vector<Planner> planners;   ///< one for each score
  std::vector<DriveScore> scores;  ///< not empty
  Verdict verdict = Verdict::pass;
};
Document match_document(const MatchAnswer& answer);

/// One part of the energy that left the battery.
struct EnergyPart {
  std::string_view name;  ///< also the key in the JSON, without its unit
  double EnergyAccount::*value;
};
std::span<const EnergyPart> energy_parts();

/// `result` is the evaluation of `motor` alone, `trace` its temperatures over time.
Document load_simulation_document(const MotorEvaluation& result, const Trace& trace, const Robot& robot, const Motor& motor,
                                  const Duty& duty, double duration_s);

}  // namespace heatsoak::present
