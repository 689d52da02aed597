// Short scripted drives for tests and reports: straight lines, with wrong friction in the core or a dirty wheel on the robot.
#pragma once

#include <functional>
#include <vector>

#include "simulate/drive_script.h"

namespace heatsoak::simulate {

/// From a stand to a constant velocity, then on until the end; the heading is held.
struct StraightDrive {
  double direction_rad = 0.0;  ///< of travel, from straight ahead, counter-clockwise
  double speed_m_per_s = 0.3;
  double acceleration_m_per_s2 = 1.0;
  double jerk_m_per_s3 = 20.0;
  double duration_s = 2.0;
};

/// One period of the plant.
struct DriveMoment {
  double time_s = 0.0;
  robot::Pose plan;
  robot::Pose pose;
  robot::BodyVelocity planned;   ///< field frame
  robot::BodyVelocity velocity;  ///< field frame
  robot::PerWheel wheel_speed_rad_per_s{};
  robot::PerWheel current_A{};
  robot::PerWheel terminal_V{};
  robot::PerWheel slip_m_per_s{};
  std::array<robot_core::Reason, robot::kMostWheels> reason{};
};

struct DrivenLine {
  std::vector<DriveMoment> moments;
  double speed_error_rms_m_per_s = 0.0;     ///< of the velocity vector against the plan's, over all of the drive
  double steady_speed_error_m_per_s = 0.0;  ///< mean along the direction over the last quarter: robot minus plan
  double direction_error_rad = 0.0;         ///< of the velocity, mean over the last quarter, counter-clockwise
  double distance_error_m = 0.0;            ///< between plan and robot at the end
  double yaw_error_rad = 0.0;               ///< at the end
};

/// The robot starts at rest at the field's centre, looks along x, and its motors are at `ambient_C`.
DrivenLine drive_straight(const robot::Robot& robot, const motor::Motor& motor, const robot_core::Config& core, const DriveOptions& options,
                          const StraightDrive& drive, double ambient_C = 25.0);

/// The real drive without what the team's computer corrects: the core alone keeps the course.
DriveOptions without_position_feedback(DriveOptions options);

/// The Config with its friction (a, b and the constant of rotation; not d, which is mostly back-EMF) times `factor`; 0: no feed-forward of
/// friction.
robot_core::Config with_friction_factor(robot_core::Config config, double factor);

/// The robot with `factor` times the constant friction of one wheel (from 0), as dirt in its bearing and rollers makes it. Throws Failure
/// (bad_input) where the robot's file has no [friction.heading]: without it all wheels have one friction.
robot::Robot with_dirty_wheel(const robot::Robot& robot, std::size_t wheel, double factor);

}  // namespace heatsoak::simulate
