#include "cli/match_roles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "cli/command.h"

namespace heatsoak {
namespace {

/// Returns ∫M²dt summed over all wheels.
double effort_Nm2_s(const PhaseLoad& phase) {
  return std::accumulate(phase.torque_squared_Nm2_s.begin(), phase.torque_squared_Nm2_s.end(), 0.0);
}

double effort_Nm2_s(const MatchLoad& load) {
  return std::accumulate(load.phases.begin(), load.phases.end(), 0.0,
                         [](double sum_Nm2_s, const PhaseLoad& phase) { return sum_Nm2_s + effort_Nm2_s(phase); });
}

double torque_rms_Nm(const MatchLoad& load) {
  return std::sqrt(effort_Nm2_s(load) / load.duration_s / static_cast<double>(load.wheels.size()));
}

double most_effort_Nm2_s(const RoleLoads& roles) {
  double most_Nm2_s = 0.0;
  for (const MatchLoad& load : roles) {
    most_Nm2_s = std::max(most_Nm2_s, effort_Nm2_s(load));
  }
  return most_Nm2_s;
}

/// Returns a table row with a share of ∫M²dt for each role, relative to that role's total.
template <class Part>
std::string share_row(const RoleLoads& roles, std::string_view name, double time_s, const Part& part_Nm2_s) {
  std::string text = fmt::format("{:23} {:7.0f}", name, time_s);
  for (const MatchLoad& load : roles) {
    text += fmt::format(" {:10.1f} %", 100.0 * part_Nm2_s(load) / effort_Nm2_s(load));
  }
  return text + "\n";
}

template <class Value>
std::string total_row(const RoleLoads& roles, std::string_view name, const Value& value) {
  std::string text = fmt::format("{:31}", name);
  for (const MatchLoad& load : roles) {
    text += fmt::format(" {:>12}", value(load));
  }
  return text + "\n";
}

double duel_s(const MatchLoad& load) {
  return std::accumulate(load.phases.begin(), load.phases.end(), 0.0,
                         [](double sum_s, const PhaseLoad& phase) { return sum_s + phase.duel_s; });
}

}  // namespace

RoleLoads play_roles(const MatchInputs& inputs, const Robot& robot, std::uint64_t seed, Planner planner) {
  RoleLoads roles;
  for (std::size_t i = 0; i < roles.size(); ++i) {
    MatchInputs as_role = inputs;
    as_role.role = static_cast<Role>(i);
    roles[i] = play_match(as_role, as_role.nominal(), robot, seed, planner);
  }
  return roles;
}

std::string role_table(const RoleLoads& roles) {
  std::string text =
      fmt::format("{:23} {:>7} {:>12} {:>12} {:>12}\n", "share of torque squared", "time / s", kRoleNames[0], kRoleNames[1], kRoleNames[2]);
  for (std::size_t i = 0; i < kPhaseNames.size(); ++i) {
    const double time_s = roles.back().phases[i].time_s;
    if (time_s > 0.0) {
      text += share_row(roles, kPhaseNames[i], time_s,
                        [i](const MatchLoad& load) { return effort_Nm2_s(load.phases[i]) - load.phases[i].duel_torque_squared_Nm2_s; });
    }
  }
  std::string duels = fmt::format("{:31}", "duels (pushing at stall)");
  for (const MatchLoad& load : roles) {
    const double part_Nm2_s = std::accumulate(load.phases.begin(), load.phases.end(), 0.0, [](double sum_Nm2_s, const PhaseLoad& phase) {
      return sum_Nm2_s + phase.duel_torque_squared_Nm2_s;
    });
    duels += fmt::format(" {:10.1f} %", 100.0 * part_Nm2_s / effort_Nm2_s(load));
  }
  text += duels + "\n";
  const double most_Nm2_s = most_effort_Nm2_s(roles);
  text += total_row(roles, "  time in them / s", [](const MatchLoad& load) { return fmt::format("{:.0f}", duel_s(load)); });
  text += total_row(roles, "driven / m", [](const MatchLoad& load) { return fmt::format("{:.0f}", load.distance_m); });
  text += total_row(roles, "torque of a mean wheel / mN m rms",
                    [](const MatchLoad& load) { return fmt::format("{:.1f}", 1e3 * torque_rms_Nm(load)); });
  text += total_row(roles, "torque squared / busiest role's",
                    [&](const MatchLoad& load) { return fmt::format("{:.0f} %", 100.0 * effort_Nm2_s(load) / most_Nm2_s); });
  return text;
}

nlohmann::ordered_json role_json(const RoleLoads& roles) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  const double most_Nm2_s = most_effort_Nm2_s(roles);
  for (std::size_t r = 0; r < roles.size(); ++r) {
    const MatchLoad& load = roles[r];
    const double sum_Nm2_s = effort_Nm2_s(load);
    nlohmann::ordered_json phases = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < load.phases.size(); ++i) {
      const PhaseLoad& phase = load.phases[i];
      phases.push_back({{"phase", kPhaseNames[i]},
                        {"time_s", rounded(phase.time_s, 3)},
                        {"duel_s", rounded(phase.duel_s, 3)},
                        {"heat_share", rounded(effort_Nm2_s(phase) / sum_Nm2_s, 6)},
                        {"duel_heat_share", rounded(phase.duel_torque_squared_Nm2_s / sum_Nm2_s, 6)}});
    }
    all.push_back({{"role", kRoleNames[r]},
                   {"distance_m", rounded(load.distance_m, 1)},
                   {"torque_rms_Nm", rounded(torque_rms_Nm(load), 6)},
                   {"heat_of_busiest_share", rounded(sum_Nm2_s / most_Nm2_s, 6)},
                   {"phases", phases}});
  }
  return all;
}

}  // namespace heatsoak
