// Rest of a hot motor before it can play on: when a substituted robot may return to the field.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "duty/duty.h"
#include "motor/motor.h"
#include "robot/robot.h"

namespace heatsoak::select {

inline constexpr std::array kPlays_s{60.0, 300.0, 1200.0};
inline constexpr int kLongestRest_s = 3600;

/// Shortest rest after which the nominal motor keeps its limits during play_s of the duty.
struct RestOfHotMotor {
  double play_s = 0.0;
  /// Rest that suffices for half and for all of the places of the duty at which play may begin; empty if no rest up to kLongestRest_s does.
  std::optional<double> half_s;
  std::optional<double> all_s;
  int starts = 0;                     ///< number of these places
  int starts_never = 0;               ///< places from which even the longest rest does not suffice
  bool over_without_current = false;  ///< not below its limits even in steady state without current, so that no rest suffices
};

/// Returns the rests for kPlays_s, in whole seconds. The hot motor stood still with the current that holds its first node at the limit in
/// steady state; it rests without current. Play begins at places of the duty that are a minute or more apart, at most 16, and repeats the
/// duty if it ends. Returns nothing if no current brings the motor to a limit.
std::vector<RestOfHotMotor> rests_of_hot_motor(const robot::Robot& robot, const duty::Duty& duty, const duty::WheelDemand& demand,
                                               const motor::Motor& motor);

}  // namespace heatsoak::select
