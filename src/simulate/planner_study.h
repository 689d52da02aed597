// Effect of a planner's limits on slip, time, accuracy and heat: the same short drives with many limits.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "motor/motor.h"
#include "robot/robot.h"
#include "simulate/core_drive.h"

namespace heatsoak::simulate {

/// Limits of the planner.
struct StudyCase {
  double acceleration_m_per_s2 = 0.0;
  double jerk_m_per_s3 = 0.0;  ///< infinite: bang-bang planner
};

/// Means over the drives unless stated otherwise. A drive is straight, from rest to rest, at constant yaw.
struct StudyResult {
  StudyCase limits;
  double planned_s = 0.0;         ///< duration of the plan
  double settled_s = 0.0;         ///< time until the robot stays within kSettled_m of the target
  double slip_share = 0.0;        ///< ∫|slip|dt, mean of the wheels, per distance driven
  double sliding_share = 0.0;     ///< part of slip_share above the creep speed
  double tracking_rms_m = 0.0;    ///< RMS tracking error while the plan moves
  double overshoot_mean_m = 0.0;  ///< distance beyond the target after the plan has ended
  double peak_current_A = 0.0;    ///< largest of all drives
  double copper_J = 0.0;          ///< sum of all motors, per drive

  [[nodiscard]] bool is_bang_bang() const { return std::isinf(limits.jerk_m_per_s3); }
};
inline constexpr double kSettled_m = 0.01;

/// Drives 0.5, 1 and 2 m in eight directions of the robot, without thermal guard. The result does not depend on `threads`. Throws Failure
/// (bad_input) that names the values missing from the files of robot or motor.
std::vector<StudyResult> study_planners(const robot::Robot& robot, const motor::Motor& motor, std::span<const StudyCase> cases,
                                        const DriveOptions& drive, int threads, const base::Progress& progress = {});

/// Returns cases with three accelerations: the robot's own limit, its grip and 1.5 times its grip. Each has twelve jerks from 3 to 60 m/s³
/// and bang-bang. An acceleration within 5 % of the robot's own limit is omitted.
std::vector<StudyCase> jerk_sweep(const robot::Robot& robot);

/// Answer of `simulate --jerk-sweep`.
struct JerkSweep {
  robot::Robot robot;  ///< robot with assumed friction if its file has none
  motor::Motor motor;
  std::vector<StudyResult> results;  ///< one result per case of jerk_sweep()
};

/// Runs the study of jerk_sweep() with ideal or real sensing; `seed` is the seed of sensors and radio. Throws Failure (bad_input) that
/// names the values missing from the files of robot or motor.
JerkSweep sweep_jerk(const robot::Robot& robot, const motor::Motor& motor, bool is_sensing_ideal, std::uint64_t seed,
                     const base::Progress& progress = {});

/// Returns the acceleration from rest at which the first wheel slides, in the least favourable direction. It is less than μ·g, because some
/// wheels carry less load and push more than others.
double grip_m_per_s2(const robot::Robot& robot);

}  // namespace heatsoak::simulate
