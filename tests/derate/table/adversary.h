// Uses that try to get a winding over its limit although the guard decides the current.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "base/random.h"
#include "derate/derating.h"
#include "duty/demand.h"

namespace heatsoak::studies {

/// Held for a while. The guard's allowed current is the bound of every one.
struct Segment {
  double duration_s = 0.0;
  double share = 1.0;                                         ///< of what is allowed
  double wanted_A = std::numeric_limits<double>::infinity();  ///< and no more than this
  double speed_rad_per_s = 0.0;                               ///< magnitude
  bool is_braking = false;
  double ambient_C = 40.0;  ///< true, and told to the guard
};

struct Script {
  std::vector<Segment> segments;
  double observer_start_C = 40.0;
  double motor_start_C = 40.0;
};

inline constexpr double kScript_s = 600.0;  ///< 7 time constants of the ECX FLAT 32 L's stator

/// On and off in spells of 0.05 to 300 s, mostly all that is allowed, at any speed, driving or braking.
Script bang_bang(const BarrierRules& rules, Random& random);
/// A change of one to four segments of it.
Script mutated(const Script& script, const BarrierRules& rules, Random& random);
/// The same in air that jumps between `coldest_C` and the hottest, twelve times on average.
void step_ambient(Script& script, double coldest_C, const BarrierRules& rules, Random& random);
/// A wheel of a generated match whose driver asks for `aggressiveness` times the current, over and over for kScript_s.
Script match(const WheelDemand& wheel, const Motor& motor, const Robot& robot, const BarrierRules& rules, double aggressiveness,
             double first_share);

/// What the guard lets through, with the firmware's arithmetic.
UsePlayed play(const Script& script, const Observer& observer, const CurrentTable& table, const Motor& motor, const Robot& robot,
               double period_s);

/// Segments for a reader: "0.31 s all at 402 rad/s; 12 s none at 0 rad/s; …".
std::string to_text(const Script& script, std::size_t most);

}  // namespace heatsoak::studies
