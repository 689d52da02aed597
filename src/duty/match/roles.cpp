#include "duty/match/roles.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace heatsoak::duty {

RoleLoads play_roles(const MatchInputs& inputs, const robot::Robot& robot, std::uint64_t seed, Planner planner,
                     const base::Progress& progress) {
  RoleLoads roles;
  for (std::size_t i = 0; i < roles.size(); ++i) {
    MatchInputs as_role = inputs;
    as_role.role = static_cast<Role>(i);
    roles[i] = play_match(as_role, as_role.nominal(), robot, seed, planner);
    if (progress) {
      progress(i + 1, roles.size());
    }
  }
  return roles;
}

double effort_Nm2_s(const PhaseLoad& phase) {
  return std::accumulate(phase.torque_squared_Nm2_s.begin(), phase.torque_squared_Nm2_s.end(), 0.0);
}

double effort_Nm2_s(const MatchLoad& load) {
  return std::accumulate(load.phases.begin(), load.phases.end(), 0.0,
                         [](double sum_Nm2_s, const PhaseLoad& phase) { return sum_Nm2_s + effort_Nm2_s(phase); });
}

double duel_effort_Nm2_s(const MatchLoad& load) {
  return std::accumulate(load.phases.begin(), load.phases.end(), 0.0,
                         [](double sum_Nm2_s, const PhaseLoad& phase) { return sum_Nm2_s + phase.duel_torque_squared_Nm2_s; });
}

double most_effort_Nm2_s(const RoleLoads& roles) {
  double most_Nm2_s = 0.0;
  for (const MatchLoad& load : roles) {
    most_Nm2_s = std::max(most_Nm2_s, effort_Nm2_s(load));
  }
  return most_Nm2_s;
}

double torque_rms_Nm(const MatchLoad& load) {
  return std::sqrt(effort_Nm2_s(load) / load.duration_s / static_cast<double>(load.wheels.size()));
}

double duel_s(const MatchLoad& load) {
  return std::accumulate(load.phases.begin(), load.phases.end(), 0.0,
                         [](double sum_s, const PhaseLoad& phase) { return sum_s + phase.duel_s; });
}

}  // namespace heatsoak::duty
