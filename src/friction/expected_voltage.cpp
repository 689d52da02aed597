#include "friction/expected_voltage.h"

#include <cmath>
#include <optional>

#include "robot/inverse_dynamics.h"

namespace heatsoak::friction {
namespace {

std::optional<robot::BodyConfig> body_of(const robot::Robot& robot, const motor::MotorValues& motor) {
  try {
    return robot::make_body(robot, motor);
  } catch (const base::Failure&) {
    return std::nullopt;
  }
}

}  // namespace

Expectation expectation(const robot::Robot& robot, const motor::MotorValues& motor) {
  const robot::DriveConstants drive = robot::drive_constants(robot, motor);
  const int wheels = static_cast<int>(robot.wheels.axis_rad.size());
  Expectation found;
  robot::DriveConstants without_drag = drive;
  without_drag.drag_torque_Nm = 0.0;
  const double damping_Nm_s_per_rad = robot.friction.wheel_damping_Nm_s_per_rad.value_or(0.0);
  found.damping_V_s_per_rad = robot::steady_voltage_V(without_drag, damping_Nm_s_per_rad, 1.0);
  const std::optional<robot::BodyConfig> body = body_of(robot, motor);
  found.from = body ? ExpectedFrom::robot_file : ExpectedFrom::motor_data_sheet;
  found.voltages = [drive, wheels, body](const SteadyPart& part) {
    robot::PerWheel torque_Nm{};
    if (body) {
      const robot::BodyVelocity velocity{part.speed_m_per_s * std::cos(part.heading_rad), part.speed_m_per_s * std::sin(part.heading_rad),
                                         part.is_rotation ? part.yaw_rad_per_s : 0.0};
      torque_Nm = robot::inverse_dynamics(*body, {velocity, {}, {}, 0.0}).torque_Nm;
    }
    robot::PerWheel voltage_V{};
    for (int i = 0; i < wheels; ++i) {
      voltage_V[i] = robot::steady_voltage_V(drive, torque_Nm[i], part.wheel_speed_rad_per_s[i]);
    }
    return voltage_V;
  };
  return found;
}

}  // namespace heatsoak::friction
