// What nobody has measured of a match, as named inputs with ranges. The rules' own figures are constants.
#pragma once

#include <array>
#include <span>
#include <string_view>

#include "base/figure.h"
#include "base/parameter.h"
#include "base/random.h"
#include "input/reader.h"

namespace heatsoak {

enum class Division { a, b };
enum class Role { keeper, defender, attacker };
inline constexpr std::array<std::string_view, 3> kRoleNames{"keeper", "defender", "attacker"};

/// One draw of every input; means are of exponential distributions unless said otherwise.
struct MatchValues {
  double running_mean_s = 0.0;    ///< of an uninterrupted stretch of play
  double stop_mean_s = 0.0;       ///< of a stop, beyond the 2 s in which robots slow down
  double placement_share = 0.0;   ///< part of the interruptions that end with ball placement
  double placement_mean_s = 0.0;  ///< cut at the rules' 30 s
  double halt_count = 0.0;        ///< mean number
  double halt_mean_s = 0.0;
  double timeout_count = 0.0;      ///< mean number, of both teams
  double retarget_mean_s = 0.0;    ///< between two new targets while play runs
  double distance_median_m = 0.0;  ///< to a new target of an attacker; a defender's is half, a keeper's a quarter
  double aggressiveness = 0.0;     ///< part of the robot's limits of speed and acceleration that is used
  double duels_per_min = 0.0;      ///< of play, of an attacker; a defender has half, a keeper a tenth
  double duel_mean_s = 0.0;        ///< pushing against a robot at standstill
  double duel_push_share = 0.0;    ///< of the largest force that the robot can hold without sliding or turning
};

struct MatchInputSpec {
  ParameterSpec spec;
  double MatchValues::*value = nullptr;
};
std::span<const MatchInputSpec> match_input_specs();

struct MatchInputs {
  Division division = Division::a;
  Role role = Role::attacker;
  bool overtime = false;
  std::array<Figure, 13> figures;  ///< in the order of match_input_specs()

  [[nodiscard]] MatchValues nominal() const;
  [[nodiscard]] MatchValues draw(Random& random) const;
};

/// Problems go to the reader.
MatchInputs read_match_inputs(Reader& table);

}  // namespace heatsoak
