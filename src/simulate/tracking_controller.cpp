#include <cmath>

#include "motor/datasheet_network.h"
#include "robot/inverse_dynamics.h"
#include "robot/motor_drive.h"
#include "simulate/drive_controller.h"

namespace heatsoak {
namespace {

/// Settles within half a second, and is slow enough for a period of 10 ms.
constexpr double kFrequency_per_s = 8.0;
/// So that no acceleration is cut: the controller does not know what the ground passes on.
constexpr double kAnyGrip_ratio = 1e6;

double wrapped_rad(double angle_rad) { return std::remainder(angle_rad, 2.0 * std::acos(-1.0)); }

class TrackingController final : public DriveController {
 public:
  TrackingController(const Robot& robot, const MotorValues& motor, double period_s)
      : robot_(robot),
        body_(make_body(robot, motor)),
        electrics_(make_electrics(robot, motor)),
        driver_(make_driver(robot)),
        half_period_s_(0.5 * period_s) {
    body_.traction.traction_ratio = kAnyGrip_ratio;
  }

  std::array<MotorCommand, kMostWheels> command(const Setpoint& setpoint, const Sensed& sensed) override {
    const BodyVelocity planned{setpoint.velocity.x_m_per_s + half_period_s_ * setpoint.acceleration.x_m_per_s2,
                               setpoint.velocity.y_m_per_s + half_period_s_ * setpoint.acceleration.y_m_per_s2,
                               setpoint.velocity.yaw_rad_per_s + half_period_s_ * setpoint.acceleration.yaw_rad_per_s2};
    const double yaw_rad = sensed.pose.yaw_rad + half_period_s_ * setpoint.velocity.yaw_rad_per_s;
    BodyMotion motion = local_motion(body_, {0.0, 0.0, yaw_rad}, planned, corrected(setpoint, sensed));
    const Wrench push = to_local(setpoint.push, yaw_rad);
    motion.external = {-push.x_N, -push.y_N, -push.yaw_Nm};
    const WheelDemands wheels = inverse_dynamics(body_, motion);
    std::array<MotorCommand, kMostWheels> commands{};
    for (int i = 0; i < body_.kinematics.wheel_count; ++i) {
      commands[i] = {MotorCommand::Kind::voltage, voltage_V(wheels.torque_Nm[i], wheels.speed_rad_per_s[i])};
    }
    return commands;
  }

 private:
  [[nodiscard]] static BodyAcceleration corrected(const Setpoint& setpoint, const Sensed& sensed) {
    const BodyVelocity now = to_global(sensed.velocity, sensed.pose.yaw_rad);
    const auto correction = [](double behind, double slower) { return kFrequency_per_s * (2.0 * slower + kFrequency_per_s * behind); };
    return {setpoint.acceleration.x_m_per_s2 + correction(setpoint.pose.x_m - sensed.pose.x_m, setpoint.velocity.x_m_per_s - now.x_m_per_s),
            setpoint.acceleration.y_m_per_s2 + correction(setpoint.pose.y_m - sensed.pose.y_m, setpoint.velocity.y_m_per_s - now.y_m_per_s),
            setpoint.acceleration.yaw_rad_per_s2 +
                correction(wrapped_rad(setpoint.pose.yaw_rad - sensed.pose.yaw_rad), setpoint.velocity.yaw_rad_per_s - now.yaw_rad_per_s)};
  }

  [[nodiscard]] double voltage_V(double wheel_torque_Nm, double wheel_speed_rad_per_s) const {
    const double smoothing = body_.friction.smoothing_rad_per_s;
    const double drag_Nm = electrics_.drag_torque_Nm * wheel_speed_rad_per_s / std::hypot(wheel_speed_rad_per_s, smoothing);
    const double motor_torque_Nm = wheel_torque_Nm * shaft_torque_factor(robot_, wheel_torque_Nm * wheel_speed_rad_per_s >= 0.0);
    const double current_A = (motor_torque_Nm + drag_Nm) / electrics_.torque_constant_25C_Nm_per_A;
    const double resistance_ohm = electrics_.heating_factor * electrics_.resistance_25C_ohm + driver_.resistance_ohm;
    return resistance_ohm * current_A + electrics_.torque_constant_25C_Nm_per_A * robot_.gear_ratio * wheel_speed_rad_per_s;
  }

  Robot robot_;
  BodyConfig body_;
  MotorElectrics electrics_;
  DriverConfig driver_;
  double half_period_s_;
};

}  // namespace

std::unique_ptr<DriveController> tracking_controller(const Robot& robot, const MotorValues& motor, double period_s) {
  return std::make_unique<TrackingController>(robot, motor, period_s);
}

}  // namespace heatsoak
