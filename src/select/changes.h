// Effects of single changes on the winding temperature. The same games are driven with one value of the robot changed, with longer pauses,
// or with another motor.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/parallel.h"
#include "duty/duty.h"
#include "motor/motor.h"
#include "robot/robot.h"

namespace heatsoak::select {

enum class ChangedQuantity { acceleration, jerk, speed, yaw_acceleration, mass, wheel_radius, gear_ratio, pauses, motor };

struct ChangeEffect {
  ChangedQuantity quantity = ChangedQuantity::acceleration;
  std::optional<double> before = {};            ///< present value, in unit_of(quantity); empty for another motor
  double factor = 1.0;                          ///< ratio of the new to the present value
  std::string other_motor = {};                 ///< id; only for another motor
  double saved_K = 0.0;                         ///< decrease of the winding's peak, mean of the games; negative if it rises
  std::optional<double> standard_error_K = {};  ///< standard error of saved_K over the games; empty for one game
  bool is_deliverable = true;                   ///< voltage and current suffice in every game
  bool makes_deliverable = false;               ///< voltage or current do not suffice without the change
};

inline constexpr int kChangeGames = 4;

/// Returns the effects of all changes that are possible with these files: those of the robot, the most helpful first, then another motor.
/// All values are nominal; each game is played once for each change of the wheels' loads. A duty with a fixed wheel load counts as one
/// game; only gear ratio, pauses and motor act on it. Longer pauses extend the time without load by half. The other motor is the one of
/// `others` that keeps all limits, delivers the demand in every game and has the largest margin; there is no such effect if no motor does.
/// `others` may contain `motor`, which is ignored.
std::vector<ChangeEffect> effects_of_changes(const robot::Robot& robot, const duty::Duty& duty, const motor::Motor& motor,
                                             std::span<const motor::Motor> others, std::uint64_t seed, int threads,
                                             const base::Progress& progress = {});

/// Returns the expected duration of effects_of_changes() in s on a usual computer, for its progress; `others`: number of other motors.
double changes_work_s(const robot::Robot& robot, const duty::Duty& duty, std::size_t others);

/// Return the name of the quantity ("acceleration limit") and the unit of ChangeEffect::before.
std::string_view name_of(ChangedQuantity quantity);
std::string_view unit_of(ChangedQuantity quantity);

}  // namespace heatsoak::select
