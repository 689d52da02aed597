// A script of commands, driven in a closed loop: planner, radio, sensors, drive core, plant.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "duty/match/generator.h"
#include "simulate/core_drive.h"
#include "simulate/simulated_robot.h"

namespace heatsoak::simulate {

/// What the loop shows after every period of the plant.
struct LoopMoment {
  double time_s = 0.0;  ///< at the end of the period
  const duty::ScheduledCommand* command = nullptr;
  std::size_t command_index = 0;
  bool planned_at_rest = false;  ///< the plan of this command has ended
  bool pushes = false;
  const duty::Follower* plan = nullptr;
  const robot::PlantOutput* out = nullptr;  ///< means over the period
  const SimulatedRobot* robot = nullptr;
  const CoreDrive* drive = nullptr;
};
using LoopObserver = std::function<void(const LoopMoment&)>;

/// The robot that is pushed in a duel stands like a wall at the place where the duel began, and is somewhat soft; what it
/// is made of has no part in the force at stall.
struct Opponent {
  double stiffness_N_per_m = 5000.0;
  double damping_N_s_per_m = 100.0;
};

/// Drives `script` until `end_s`, from the plan's and the robot's present state on. In a duel the robot pushes from when its plan stands
/// still. Times of the script are taken to the nearest period of the plant.
void drive_script(SimulatedRobot& robot, CoreDrive& drive, duty::Follower& plan, std::span<const duty::ScheduledCommand> script,
                  double end_s, const LoopObserver& observer);

}  // namespace heatsoak::simulate
