// Unknown parameters of a match, each with a range. Values fixed by the rules are constants.
#pragma once

#include <array>
#include <span>
#include <string_view>

#include "base/parameter.h"
#include "base/parameter_value.h"
#include "base/random.h"
#include "input/reader.h"

namespace heatsoak::duty {

enum class Division { a, b };
enum class Role { keeper, defender, attacker };
inline constexpr std::array<std::string_view, 3> kRoleNames{"keeper", "defender", "attacker"};

/// Values of all inputs, nominal or drawn. Means belong to exponential distributions unless stated otherwise.
struct MatchValues {
  double running_mean_s = 0.0;   ///< mean duration of a segment of play; the end of the half shortens the last one
  double stop_mean_s = 0.0;      ///< mean duration of a stop; the part above stop_shortest_s is exponential
  double stop_shortest_s = 0.0;  ///< shortest duration of a stop
  double placement_share = 0.0;  ///< share of the interruptions that end with ball placement
  double placement_mean_s = 0.0;
  double halt_count = 0.0;  ///< mean number of halts
  double halt_mean_s = 0.0;
  double timeout_count = 0.0;            ///< mean number of timeouts of both teams
  double retarget_mean_s = 0.0;          ///< mean time until the next target, unless play ends first
  double distance_median_m = 0.0;        ///< median distance to a new target of an attacker
  double distance_spread_ratio = 0.0;    ///< standard deviation of the distances' logarithm
  double turn_rad = 0.0;                 ///< largest turn from target to target, either way
  double aggressiveness = 0.0;           ///< used share of the robot's limits of speed and acceleration
  double duels_per_min = 0.0;            ///< duels of an attacker per minute of play
  double duel_mean_s = 0.0;              ///< mean duration of pushing at standstill, unless play ends first
  double duel_push_share = 0.0;          ///< share of the largest force that the robot can hold without sliding or turning
  double duel_angle_rad = 0.0;           ///< largest angle between push and front, either way
  double role_distance_share = 0.0;      ///< distances of a defender relative to an attacker
  double role_duels_share = 0.0;         ///< duels of a defender relative to an attacker
  double role_zone_factor = 0.0;         ///< factor on length and width of the zones of keeper and defender
  double outside_distance_factor = 0.0;  ///< factor on the distances outside play
  double outside_speed_factor = 0.0;     ///< factor on the speeds outside play
};

struct MatchInputSpec {
  base::ParameterSpec spec;
  double MatchValues::*value = nullptr;
};
std::span<const MatchInputSpec> match_input_specs();

struct MatchInputs {
  Division division = Division::a;
  Role role = Role::attacker;
  bool overtime = false;
  std::array<base::ParameterValue, 22> parameters;  ///< in the order of match_input_specs()

  [[nodiscard]] MatchValues nominal() const;
  [[nodiscard]] MatchValues draw(base::Random& random) const;
};

/// Reads the inputs of a match. The reader collects problems.
MatchInputs read_match_inputs(input::Reader& table);

}  // namespace heatsoak::duty
