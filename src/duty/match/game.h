// Generates the phases of a game by the rules of the RoboCup Small Size League (ssl-rules @4300196). Durations are drawn from the inputs.
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

/// Rules of a phase. The clock runs only during play and before free kicks. Robots must be below 1.5 m/s 2 s after the start of a stop, and
/// stand 2 s after the start of a halt.
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

/// Returns the phases of two halves of 300 s of play with a break of 300 s (and two of 150 s in overtime). The last segment of a half ends
/// with its clock, so the time of play is exact.
std::vector<MatchPhase> generate_game(Division division, bool overtime, const MatchValues& values, base::Random& random);

}  // namespace heatsoak::duty
