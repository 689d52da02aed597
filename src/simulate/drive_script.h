// Drives a script of commands in closed loop: planner, radio, sensors, drive core, plant.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "duty/match/generator.h"
#include "simulate/core_drive.h"
#include "simulate/simulated_robot.h"

namespace heatsoak::simulate {

/// State of the loop after a plant period.
struct LoopMoment {
  double time_s = 0.0;  ///< time at the end of the period
  const duty::ScheduledCommand* command = nullptr;
  std::size_t command_index = 0;
  bool planned_at_rest = false;  ///< true if the plan of this command has ended
  bool pushes = false;           ///< true in a duel once the plan is at rest
  const duty::Follower* plan = nullptr;
  const robot::PlantOutput* out = nullptr;  ///< means over the period
  const SimulatedRobot* robot = nullptr;
  const CoreDrive* drive = nullptr;
};
using LoopObserver = std::function<void(const LoopMoment&)>;

/// Opponent in a duel: a fixed wall with spring and damper at the position where the duel begins. The force at stall does not depend on
/// these values.
struct Opponent {
  double stiffness_N_per_m = 5000.0;
  double damping_N_s_per_m = 100.0;
};

/// Drives `script` until `end_s`, starting at the present state of plan and robot. In a duel the robot pushes as soon as its plan is at
/// rest. Times of the script are rounded to the nearest plant period.
void drive_script(SimulatedRobot& robot, CoreDrive& drive, duty::Follower& plan, std::span<const duty::ScheduledCommand> script,
                  double end_s, const LoopObserver& observer);

}  // namespace heatsoak::simulate
