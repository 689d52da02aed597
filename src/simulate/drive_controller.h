// The seat of the drive core: from what the planner wants and what the robot senses to the motors' commands.
#pragma once

#include <array>
#include <memory>

#include "robot/driver.h"
#include "robot/kinematics.h"

namespace heatsoak {

/// The planner's state at the beginning of a control period, and a push on top of it. All in the global frame.
struct Setpoint {
  Pose pose;
  BodyVelocity velocity;
  BodyAcceleration acceleration;
  Wrench push;  ///< on another robot
};

/// What the robot knows of itself.
struct Sensed {
  Pose pose;              ///< global frame
  BodyVelocity velocity;  ///< local frame
  PerWheel wheel_speed_rad_per_s{};
};

/// Called once per control period of the firmware; the commands are held until the next call.
class DriveController {
 public:
  virtual ~DriveController() = default;
  virtual std::array<MotorCommand, kMostWheels> command(const Setpoint& setpoint, const Sensed& sensed) = 0;
};

/// A plain controller until the drive core takes the seat. It knows the robot's file and its cold motor, but neither grip
/// nor slip nor temperature:
///   a_i = a_ref + 2·ω·(v_ref − v) + ω²·(p_ref − p)    along x, y and yaw, ω = 8 1/s,
///   torques by inverse dynamics of a at the planned velocity (friction and push included),
///   U = (R25·k + R_driver)·I + K_t·n·ω_ref             so that a wheel that runs away meets its back-EMF.
/// The planned velocity is that of the middle of the period, so that holding a command does not make it late.
std::unique_ptr<DriveController> tracking_controller(const Robot& robot, const MotorValues& motor, double period_s);

}  // namespace heatsoak
