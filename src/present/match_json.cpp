#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "base/number_ranges.h"
#include "present/default_spreads_json.h"
#include "present/match.h"
#include "simulate/reason_name.h"

namespace heatsoak::present {
namespace {

Json guard_json(const simulate::MatchSimulation& match) {
  const simulate::MotorGuard& guard = match.guard;
  const bool is_missing = match.guard_use != simulate::GuardUse::off && !guard.guard;
  return {{"use", is_missing ? simulate::kGuardUses[0] : simulate::kGuardUses[static_cast<std::size_t>(match.guard_use)]},
          {"asked_for", simulate::kGuardUses[static_cast<std::size_t>(match.guard_use)]},
          {"why_none", is_missing && guard.why_none ? Json(guard.why_none->message()) : Json()},
          {"heat_reserve_ratio", guard.derating ? rounded(guard.derating->observer.heat_safety_factor(), 4) : Json()}};
}

Json upper_of(const simulate::DrivenMatch& driven, double simulate::DriveScore::*peak_C) {
  return driven.upper ? rounded((*driven.upper).*peak_C, 3) : Json();
}

Json json(const simulate::DrivenMatch& driven) {
  const simulate::DriveScore& s = driven.run.score;
  Json limited;
  for (std::size_t limit = 0; limit < simulate::kLimits.size(); ++limit) {
    limited[std::string(simulate::to_string(simulate::kLimits[limit]))] = rounded(s.limited_s[limit], 3);
  }
  Json energy{{"battery_J", rounded(s.energy.battery_J, 2)}};
  for (const EnergyPart& row : energy_parts()) {
    energy[fmt::format("{}_J", row.name)] = rounded(s.energy.*row.value, 2);
  }
  energy["kinetic_J"] = rounded(s.energy.kinetic_J, 4);
  energy["external_J"] = rounded(s.energy.external_J, 4);
  energy["residual_J"] = rounded(s.energy.residual_J(), 4);
  Json phases = Json::array();
  for (std::size_t i = 0; i < driven.run.phases.size(); ++i) {
    phases.push_back({{"phase", duty::kPhaseNames[i]},
                      {"time_s", rounded(driven.run.phases[i].time_s, 3)},
                      {"copper_J", rounded(driven.run.phases[i].copper_J, 3)}});
  }
  Json result{{"planner", duty::to_string(driven.planner)},
              {"verdict", select::to_string(driven.verdict)},
              {"distance_m", rounded(s.distance_m, 2)},
              {"slip_m", rounded(s.slip_m, 4)},
              {"sliding_m", rounded(s.sliding_m, 4)},
              {"sliding_s", rounded(s.sliding_s, 3)},
              {"lifted_s", rounded(s.lifted_s, 3)},
              {"tracking_rms_m", rounded(s.tracking_rms_m, 6)},
              {"tracking_most_m", rounded(s.tracking_most_m, 5)},
              {"arrivals", s.arrivals_count},
              {"overshoot_mean_m", rounded(s.overshoot_mean_m, 6)},
              {"overshoot_most_m", rounded(s.overshoot_most_m, 5)},
              {"peak_current_A", rounded(s.peak_current_A, 3)},
              {"current_rms_A", rounded(s.current_rms_A, 4)},
              {"short_s", rounded(s.short_s, 3)},
              {"lowest_battery_V", rounded(s.lowest_battery_V, 3)},
              {"battery_empty_s", rounded(s.battery_empty_s, 3)},
              {"winding_peak_C", rounded(s.winding_peak_C, 3)},
              {"upper_winding_peak_C", upper_of(driven, &simulate::DriveScore::winding_peak_C)},
              {"stator_peak_C", rounded(s.stator_peak_C, 3)},
              {"duel_copper_share", rounded(s.duel_copper_share, 4)},
              {"guard_limited_s", rounded(s.guard_limited_s, 3)},
              {"guard_missing_A_s", rounded(s.guard_missing_A_s, 3)},
              {"guard_winding_peak_C", rounded(s.guard_winding_peak_C, 3)},
              {"limited_s", limited},
              {"fault_s", rounded(s.fault_s, 3)},
              {"lost_packets_share", rounded(s.lost_packets_share, 5)},
              {"energy", energy},
              {"phases", phases}};
  return base::with_ranges(
      std::move(result),
      {{"distance_m", base::kNotNegative},        {"slip_m", base::kNotNegative},      {"sliding_m", base::kNotNegative},
       {"sliding_s", base::kNotNegative},         {"lifted_s", base::kNotNegative},    {"tracking_rms_m", base::kNotNegative},
       {"tracking_most_m", base::kNotNegative},   {"arrivals", base::kNotNegative},    {"peak_current_A", base::kNotNegative},
       {"current_rms_A", base::kNotNegative},     {"short_s", base::kNotNegative},     {"lowest_battery_V", base::kNotNegative},
       {"battery_empty_s", base::kNotNegative},   {"duel_copper_share", base::kShare}, {"guard_limited_s", base::kNotNegative},
       {"guard_missing_A_s", base::kNotNegative}, {"limited_s", base::kNotNegative},   {"fault_s", base::kNotNegative},
       {"lost_packets_share", base::kShare},      {"time_s", base::kNotNegative},      {"copper_J", base::kNotNegative}});
}

Json balance_json(const select::Trace& trace) {
  Json rows = Json::array();
  for (const select::BookedHeat& each : trace.balance) {
    rows.push_back({{"effect", each.effect}, {"node", each.node}, {"mean_W", rounded(each.mean_W, 6)}});
  }
  return rows;
}

}  // namespace

Json match_json(const simulate::MatchSimulation& match) {
  const simulate::DrivenMatch& deciding = match.deciding();
  const simulate::DriveScore& score = deciding.run.score;
  Json planners = Json::array();
  for (const simulate::DrivenMatch& each : match.runs) {
    planners.push_back(json(each));
  }
  Json answer{{"schema", "heatsoak.simulate/1"},
              {"motor", match.motor.id},
              {"conditions", match.motor.assumed},
              {"robot", match.robot.id},
              {"duty", match.duty.id},
              {"duty_origin", match.duty.origin},
              {"seed", match.seed},
              {"planner", duty::to_string(deciding.planner)},
              {"duration_s", rounded(score.time_s, 3)},
              {"wheel", fmt::format("wheel {}", score.hottest_wheel + 1)},
              {"winding_peak_C", rounded(score.winding_peak_C, 3)},
              {"upper_winding_peak_C", upper_of(deciding, &simulate::DriveScore::winding_peak_C)},
              {"upper_stator_peak_C", upper_of(deciding, &simulate::DriveScore::stator_peak_C)},
              {"stator_peak_C", rounded(score.stator_peak_C, 3)},
              {"winding_limit_C", rounded(match.motor.nominal.winding_limit_C, 2)},
              {"current_rms_A", rounded(score.current_rms_A, 4)},
              {"verdict", select::to_string(deciding.verdict)},
              {"data_quality", motor::data_quality(match.motor)},
              {"is_friction_assumed", match.robot.friction.is_assumed},
              {"sensing", match.is_sensing_ideal ? "ideal" : "real"},
              {"guard", guard_json(match)},
              {"default_spreads", match.guard_use != simulate::GuardUse::off ? default_spreads_json({&match.motor, 1}) : Json::array()},
              {"planners", planners}};
  return base::with_ranges(std::move(answer), {{"duration_s", base::kNotNegative}, {"current_rms_A", base::kNotNegative}});
}

Json load_simulation_json(const select::LoadSimulation& simulation) {
  const select::MotorEvaluation& result = simulation.result;
  Json answer{{"schema", "heatsoak.simulate/1"},
              {"motor", simulation.motor.id},
              {"conditions", simulation.motor.assumed},
              {"robot", simulation.robot.id},
              {"duty", simulation.duty.id},
              {"duty_origin", simulation.duty.origin},
              {"wheel", result.wheel},
              {"winding_peak_C", rounded(result.winding_peak_C.nominal, 3)},
              {"upper_winding_peak_C", simulation.upper ? rounded(simulation.upper->winding_C, 3) : Json()},
              {"upper_stator_peak_C", simulation.upper ? rounded(simulation.upper->stator_C, 3) : Json()},
              {"stator_peak_C", rounded(result.stator_peak_C.nominal, 3)},
              {"winding_limit_C", rounded(result.winding_limit_C, 2)},
              {"current_rms_A", rounded(result.current_rms_A, 4)},
              {"verdict", select::to_string(result.verdict)},
              {"data_quality", result.data_quality},
              {"balance", balance_json(simulation.trace)},
              {"stored_W", rounded(simulation.trace.stored_W, 6)}};
  return base::with_ranges(std::move(answer), {{"current_rms_A", base::kNotNegative}});
}

}  // namespace heatsoak::present
