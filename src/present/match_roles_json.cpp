#include "present/match_roles_json.h"

#include <nlohmann/json.hpp>

#include "base/number_ranges.h"

namespace heatsoak::present {

Json role_json(const duty::RoleLoads& roles) {
  Json all = Json::array();
  const double most_Nm2_s = duty::most_effort_Nm2_s(roles);
  for (std::size_t r = 0; r < roles.size(); ++r) {
    const duty::MatchLoad& load = roles[r];
    const double sum_Nm2_s = duty::effort_Nm2_s(load);
    Json phases = Json::array();
    for (std::size_t i = 0; i < load.phases.size(); ++i) {
      const duty::PhaseLoad& phase = load.phases[i];
      phases.push_back({{"phase", duty::kPhaseNames[i]},
                        {"time_s", rounded(phase.time_s, 3)},
                        {"duel_s", rounded(phase.duel_s, 3)},
                        {"heat_share", rounded(duty::effort_Nm2_s(phase) / sum_Nm2_s, 6)},
                        {"duel_heat_share", rounded(phase.duel_torque_squared_Nm2_s / sum_Nm2_s, 6)}});
    }
    Json role{{"role", duty::kRoleNames[r]},
              {"distance_m", rounded(load.distance_m, 1)},
              {"torque_rms_Nm", rounded(duty::torque_rms_Nm(load), 6)},
              {"heat_of_busiest_share", rounded(sum_Nm2_s / most_Nm2_s, 6)},
              {"phases", phases}};
    all.push_back(base::with_ranges(std::move(role), {{"distance_m", base::kNotNegative},
                                                      {"torque_rms_Nm", base::kNotNegative},
                                                      {"heat_of_busiest_share", base::kShare},
                                                      {"time_s", base::kNotNegative},
                                                      {"duel_s", base::kNotNegative},
                                                      {"heat_share", base::kShare},
                                                      {"duel_heat_share", base::kShare}}));
  }
  return all;
}

}  // namespace heatsoak::present
