// Effect of a planner's limits on slip, time, precision and heat: the same short drives under many of them.
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
  double jerk_m_per_s3 = 0.0;  ///< infinite: bang-bang, the acceleration jumps
};

/// Means over the drives unless said otherwise. A drive goes from rest to rest, straight, with the yaw held.
struct StudyResult {
  StudyCase limits;
  double planned_s = 0.0;
  double settled_s = 0.0;         ///< until the robot is within kSettled_m of the target for good
  double slip_share = 0.0;        ///< ∫|slip|dt of a mean wheel per distance driven
  double sliding_share = 0.0;     ///< the part of it beyond creep
  double tracking_rms_m = 0.0;    ///< while the plan moves
  double overshoot_mean_m = 0.0;  ///< beyond the target after the plan has ended
  double peak_current_A = 0.0;    ///< the highest of all drives
  double copper_J = 0.0;          ///< all motors together, per drive

  [[nodiscard]] bool is_bang_bang() const { return std::isinf(limits.jerk_m_per_s3); }
};
inline constexpr double kSettled_m = 0.01;

/// Drives of 0.5, 1 and 2 m in eight directions of the robot, without thermal guard. The same for every number of threads.
/// Throws Failure (bad_input) that names what the files of robot or motor lack.
std::vector<StudyResult> study_planners(const robot::Robot& robot, const motor::Motor& motor, std::span<const StudyCase> cases,
                                        const DriveOptions& drive, int threads, const base::Progress& progress = {});

/// Cases around a robot's own limits: its acceleration, its grip and half as much again, each with twelve jerks from 3
/// to 60 m/s³ and bang-bang. Where two of the three are within 5 % of each other, the robot's own stands for both.
std::vector<StudyCase> jerk_sweep(const robot::Robot& robot);

/// The answer of `simulate --jerk-sweep`.
struct JerkSweep {
  robot::Robot robot;  ///< with assumed friction if its file has none
  motor::Motor motor;
  std::vector<StudyResult> results;  ///< results of jerk_sweep()
};

/// Runs the study of jerk_sweep() with ideal or real sensing; `seed` is that of sensors and radio. Throws Failure (bad_input) that names
/// what the files of robot or motor lack.
JerkSweep sweep_jerk(const robot::Robot& robot, const motor::Motor& motor, bool is_sensing_ideal, std::uint64_t seed,
                     const base::Progress& progress = {});

/// The acceleration from rest at which the first wheel slides, in the least favourable direction: less than μ·g, because
/// some wheels bear less and push more than others.
double grip_m_per_s2(const robot::Robot& robot);

}  // namespace heatsoak::simulate
