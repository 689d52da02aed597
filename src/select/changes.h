// What a change of the robot would do to a motor's winding: the same games, driven by a robot with one number changed.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "base/parallel.h"
#include "duty/duty.h"
#include "motor/motor.h"
#include "robot/robot.h"

namespace heatsoak {

enum class ChangedQuantity { acceleration, jerk, speed, yaw_acceleration, mass, wheel_radius, gear_ratio };

struct ChangeEffect {
  ChangedQuantity quantity = ChangedQuantity::acceleration;
  double before = 0.0;            ///< value of the robot's file, in unit_of(quantity)
  double factor = 1.0;            ///< what it was multiplied by
  double saved_K = 0.0;           ///< fall of the winding's peak, mean of the games; negative where it rises
  double standard_error_K = 0.0;  ///< of that mean, from the differences game by game; NaN for one game
  bool is_deliverable = true;     ///< voltage and current suffice in every game
};

inline constexpr int kChangeGames = 4;

/// Every change that the robot's file has the number for, the most helpful first. Nominal values; each game costs as much as playing it
/// once. A duty that fixes the wheel's load is one game, and only the gear ratio acts on it.
std::vector<ChangeEffect> effects_of_changes(const Robot& robot, const Duty& duty, const Motor& motor, std::uint64_t seed, int threads,
                                             const Progress& progress = {});

/// "acceleration limit", and the unit of `before`.
std::string_view name_of(ChangedQuantity quantity);
std::string_view unit_of(ChangedQuantity quantity);

}  // namespace heatsoak
