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

/// One draw of every input; means are of exponential distributions unless said otherwise.
struct MatchValues {
  double running_mean_s = 0.0;   ///< mean duration of a segment of play; the end of the half shortens the last one
  double stop_mean_s = 0.0;      ///< of a stop, whose part beyond the shortest is exponential
  double stop_shortest_s = 0.0;  ///< robots slow down, the ball is looked for
  double placement_share = 0.0;  ///< part of the interruptions that end with ball placement
  double placement_mean_s = 0.0;
  double halt_count = 0.0;  ///< mean number
  double halt_mean_s = 0.0;
  double timeout_count = 0.0;            ///< mean number, of both teams
  double retarget_mean_s = 0.0;          ///< until the next target, unless play ends first
  double distance_median_m = 0.0;        ///< to a new target of an attacker
  double distance_spread_ratio = 0.0;    ///< standard deviation of the distances' logarithm
  double turn_rad = 0.0;                 ///< largest turn from target to target, either way
  double aggressiveness = 0.0;           ///< part of the robot's limits of speed and acceleration that is used
  double duels_per_min = 0.0;            ///< of play, of an attacker
  double duel_mean_s = 0.0;              ///< pushing against a robot at standstill, unless play ends first
  double duel_push_share = 0.0;          ///< of the largest force that the robot can hold without sliding or turning
  double duel_angle_rad = 0.0;           ///< largest angle between push and front, either way
  double role_distance_share = 0.0;      ///< a defender's part of an attacker's
  double role_duels_share = 0.0;         ///< a defender's part of an attacker's
  double role_zone_factor = 0.0;         ///< factor on length and width of the zones of keeper and defender
  double outside_distance_factor = 0.0;  ///< factor on the ways outside play
  double outside_speed_factor = 0.0;     ///< factor on the speeds there
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

/// Problems go to the reader.
MatchInputs read_match_inputs(input::Reader& table);

}  // namespace heatsoak::duty
