// Load sequences that try to heat a winding over its limit although the guard limits the current.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "base/random.h"
#include "derate/derating.h"
#include "duty/demand.h"

namespace heatsoak::derate::studies {

/// Load that is held for a while. The guard's allowed current always applies.
struct Segment {
  double duration_s = 0.0;
  double share = 1.0;                                         ///< share of the allowed current
  double wanted_A = std::numeric_limits<double>::infinity();  ///< additional upper limit
  double speed_rad_per_s = 0.0;                               ///< absolute value
  bool is_braking = false;
  double ambient_C = 40.0;  ///< true value, which the guard also gets
};

struct Script {
  std::vector<Segment> segments;
  double observer_start_C = 40.0;
  double motor_start_C = 40.0;
};

inline constexpr double kScript_s = 600.0;  ///< 7 time constants of the stator of the ECX FLAT 32 L

/// Returns on-off loads that last 0.05 to 300 s, mostly with the full allowed current, at any speed, driving or braking.
Script bang_bang(const BarrierRules& rules, base::Random& random);
/// Returns the script with one to four changed segments.
Script mutated(const Script& script, const BarrierRules& rules, base::Random& random);
/// Makes the air temperature jump between `coldest_C` and the hottest, twelve times on average.
void step_ambient(Script& script, double coldest_C, const BarrierRules& rules, base::Random& random);
/// Repeats the load of a wheel of a generated match with `aggressiveness` times the current for kScript_s.
Script match(const duty::WheelDemand& wheel, const motor::Motor& motor, const robot::Robot& robot, const BarrierRules& rules,
             double aggressiveness, double first_share);

/// Returns the load that the guard lets through, with the firmware's arithmetic.
UsePlayed play(const Script& script, const Observer& observer, const CurrentTable& table, const motor::Motor& motor,
               const robot::Robot& robot, double period_s);

/// Formats segments: "0.31 s all at 402 rad/s; 12 s none at 0 rad/s; …".
std::string to_text(const Script& script, std::size_t most);

}  // namespace heatsoak::derate::studies
