// Short straight drives for tests and reports, with wrong friction in the core or a dirty wheel on the robot.
#pragma once

#include <functional>
#include <vector>

#include "simulate/drive_script.h"

namespace heatsoak::simulate {

/// Drive from rest to a constant velocity, which is held until the end. The heading is constant.
struct StraightDrive {
  double direction_rad = 0.0;  ///< direction of travel, from straight ahead, counter-clockwise
  double speed_m_per_s = 0.3;
  double acceleration_m_per_s2 = 1.0;
  double jerk_m_per_s3 = 20.0;
  double duration_s = 2.0;
};

/// Values of one plant period.
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
  double speed_error_rms_m_per_s = 0.0;     ///< RMS error of the velocity vector over the whole drive
  double steady_speed_error_m_per_s = 0.0;  ///< robot minus plan along the direction, mean of the last quarter
  double direction_error_rad = 0.0;         ///< error of the velocity's direction, mean of the last quarter, counter-clockwise
  double distance_error_m = 0.0;            ///< distance between plan and robot at the end
  double yaw_error_rad = 0.0;               ///< robot minus plan at the end
};

/// Runs the drive. The robot starts at rest at the centre of the field, heading along x, with its motors at `ambient_C`. Throws Failure
/// (bad_input) if the drive is shorter than four plant periods.
DrivenLine drive_straight(const robot::Robot& robot, const motor::Motor& motor, const robot_core::Config& core, const DriveOptions& options,
                          const StraightDrive& drive, double ambient_C = 25.0);

/// Returns the options without position and heading corrections of the team's computer, so that the core alone keeps the course.
DriveOptions without_position_feedback(DriveOptions options);

/// Returns the Config with its friction (a, b and the constant of rotation; not d, which is mostly back-EMF) multiplied by `factor`. The
/// factor 0 disables the feed-forward of friction.
robot_core::Config with_friction_factor(robot_core::Config config, double factor);

/// Returns the robot with the constant friction of one wheel (index from 0) multiplied by `factor`, as caused by dirt in bearing and
/// rollers. Throws Failure (bad_input) if the robot file has no [friction.heading], because all wheels then share one friction.
robot::Robot with_dirty_wheel(const robot::Robot& robot, std::size_t wheel, double factor);

}  // namespace heatsoak::simulate
