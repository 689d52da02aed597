#include <nlohmann/json.hpp>

#include "base/number_ranges.h"
#include "present/duty.h"
#include "present/game_words.h"
#include "present/match_roles_json.h"

namespace heatsoak::present {
namespace {

Json phase_json(const duty::MatchLoad& load) {
  Json phases = Json::array();
  for (std::size_t i = 0; i < load.phases.size(); ++i) {
    const duty::PhaseLoad& phase = load.phases[i];
    phases.push_back({{"phase", duty::kPhaseNames[i]},
                      {"time_s", rounded(phase.time_s, 3)},
                      {"duel_s", rounded(phase.duel_s, 3)},
                      {"slip_s", rounded(phase.slip_s, 3)},
                      {"torque_squared_Nm2_s", phase.torque_squared_Nm2_s},
                      {"duel_torque_squared_Nm2_s", phase.duel_torque_squared_Nm2_s}});
  }
  return phases;
}

Json json_of(const duty::DutyAnswer& answer, const duty::PrescribedLoad& load) {
  return {{"schema", "heatsoak.duty/1"}, {"duty", answer.duty->id}, {"origin", answer.duty->origin}, {"duration_s", load.duration_s}};
}

Json json_of(const duty::DutyAnswer& answer, const duty::GeneratedMatch& match) {
  return {{"schema", "heatsoak.duty/1"},
          {"duty", answer.duty->id},
          {"robot", answer.robot.id},
          {"origin", answer.duty->origin},
          {"seed", match.seed},
          {"duration_s", rounded(match.load.duration_s, 3)},
          {"play_s", rounded(match.load.play_s, 3)},
          {"distance_m", rounded(match.load.distance_m, 1)},
          {"phases", phase_json(match.load)},
          {"roles", role_json(match.roles)}};
}

Json json_of(const duty::DutyAnswer& answer, const duty::GameDemand& game) {
  return {{"schema", "heatsoak.duty/1"},
          {"log", answer.log},
          {"player", game.player},
          {"robot", answer.robot.id},
          {"duration_s", rounded(game.wheels.front().duration_s(), 3)},
          {"report", words_of(game)}};
}

}  // namespace

Json duty_json(const duty::DutyAnswer& answer) {
  return base::with_ranges(std::visit([&](const auto& content) { return json_of(answer, content); }, answer.content),
                           {{"duration_s", base::kNotNegative},
                            {"play_s", base::kNotNegative},
                            {"distance_m", base::kNotNegative},
                            {"time_s", base::kNotNegative},
                            {"duel_s", base::kNotNegative},
                            {"slip_s", base::kNotNegative},
                            {"torque_squared_Nm2_s", base::kNotNegative},
                            {"duel_torque_squared_Nm2_s", base::kNotNegative}});
}

}  // namespace heatsoak::present
