// The phases of a game by the rules of the RoboCup Small Size League (ssl-rules @4300196), lengths drawn from the inputs.
#pragma once

#include <array>
#include <limits>
#include <string_view>
#include <vector>

#include "base/random.h"
#include "duty/match/match_inputs.h"

namespace heatsoak::duty {

enum class Phase { kick_off_preparation, running, stop, free_kick, ball_placement, halt, timeout, half_time };
inline constexpr std::array<std::string_view, 8> kPhaseNames{"kick_off_preparation", "running", "stop",    "free_kick",
                                                             "ball_placement",       "halt",    "timeout", "half_time"};

struct MatchPhase {
  Phase phase = Phase::halt;
  double duration_s = 0.0;
};

/// What the rules say of a phase: the clock stands except while play runs or a free kick is awaited; robots
/// are below 1.5 m/s 2 s into a stop and stand 2 s into a halt.
struct PhaseRule {
  bool clock_runs = false;
  double speed_limit_m_per_s = std::numeric_limits<double>::infinity();
  double settle_s = 0.0;  ///< time until the limit holds
};
PhaseRule rule_of(Phase phase);

struct FieldSize {
  double length_m = 0.0;
  double width_m = 0.0;
};
FieldSize field_of(Division division);

/// Two halves of 300 s of play with 300 s between them (and two of 150 s in overtime). The last segment of
/// a half is cut where its clock ends, so that play adds up exactly.
std::vector<MatchPhase> generate_game(Division division, bool overtime, const MatchValues& values, base::Random& random);

}  // namespace heatsoak::duty
