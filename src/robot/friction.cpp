#include "robot/friction.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "motor/datasheet_network.h"

namespace heatsoak {
namespace {

double smooth_sign(double x, double width) { return x / std::sqrt(x * x + width * width); }

/// γ: 0 in translation, 1 where the contact points move more by rotation.
double rotation_share(const Kinematics& kinematics, const BodyVelocity& local, double speed_m_per_s) {
  const double turning_m_per_s = kinematics.contact_radius_m * std::abs(local.yaw_rad_per_s);
  if (turning_m_per_s == 0.0) {
    return 0.0;
  }
  return turning_m_per_s >= speed_m_per_s ? 1.0 : 0.5 * (1.0 - std::cos(std::numbers::pi * turning_m_per_s / speed_m_per_s));
}

/// |f(θ)| of the wheels, rotation mixed in.
PerWheel heading_magnitudes_Nm(const HeadingFriction& heading, const Kinematics& kinematics, const BodyVelocity& local) {
  const double speed_m_per_s = std::hypot(local.x_m_per_s, local.y_m_per_s);
  const double rotation = rotation_share(kinematics, local, speed_m_per_s);
  const double x = speed_m_per_s > 0.0 ? local.x_m_per_s / speed_m_per_s : 0.0;
  const double y = speed_m_per_s > 0.0 ? local.y_m_per_s / speed_m_per_s : 0.0;
  PerWheel magnitude_Nm{};
  for (int i = 0; i < kinematics.wheel_count; ++i) {
    const double s = std::abs(kinematics.wheels[i].rolling_x_share * x + kinematics.wheels[i].rolling_y_share * y);
    // sin(2θ + φ) of the unit vector (x, y)
    const double phase_rad = heading.double_angle_phase_rad[i];
    const double twice = 2.0 * x * y * std::cos(phase_rad) + (x * x - y * y) * std::sin(phase_rad);
    const double translation_Nm = heading.constant_Nm + heading.sine_Nm * s + heading.double_angle_Nm * twice;
    magnitude_Nm[i] = (1.0 - rotation) * translation_Nm + rotation * heading.rotation_Nm;
  }
  return magnitude_Nm;
}

}  // namespace

PerWheel friction_torques_Nm(const FrictionConfig& friction, const Kinematics& kinematics, const BodyVelocity& local,
                             const PerWheel& wheel_speed_rad_per_s) {
  PerWheel torque_Nm;
  torque_Nm.fill(friction.wheel_torque_Nm);
  if (friction.by_heading) {
    torque_Nm = heading_magnitudes_Nm(friction.heading, kinematics, local);
  }
  for (int i = 0; i < kinematics.wheel_count; ++i) {
    torque_Nm[i] = torque_Nm[i] * smooth_sign(wheel_speed_rad_per_s[i], friction.smoothing_rad_per_s) +
                   friction.wheel_damping_Nm_s_per_rad * wheel_speed_rad_per_s[i];
  }
  return torque_Nm;
}

double friction_torque_of_voltage_Nm(const MotorValues& motor, double gear_ratio, double voltage_V) {
  const double motor_torque_Nm = voltage_V / motor.terminal_resistance_ohm * motor.torque_constant_Nm_per_A;
  return std::max(0.0, motor_torque_Nm - drag_torque_Nm(motor)) * gear_ratio;
}

double damping_of_voltage_Nm_s_per_rad(const MotorValues& motor, double gear_ratio, double damping_V_s_per_rad) {
  const double beyond_back_emf_V_s_per_rad = damping_V_s_per_rad / gear_ratio - motor.torque_constant_Nm_per_A;
  return std::max(0.0, beyond_back_emf_V_s_per_rad) * motor.torque_constant_Nm_per_A / motor.terminal_resistance_ohm * gear_ratio *
         gear_ratio;
}

}  // namespace heatsoak
