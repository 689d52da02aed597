#include "robot/friction.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "robot/driver.h"
#include "robot/wheel_laws.h"

namespace heatsoak::robot {
namespace {

/// Returns γ: 0 in translation, 1 if rotation moves the contact points at least as fast as translation.
double rotation_share(double contact_radius_m, const BodyVelocity& local, double speed_m_per_s) {
  const double turning_m_per_s = contact_radius_m * std::abs(local.yaw_rad_per_s);
  if (turning_m_per_s == 0.0) {
    return 0.0;
  }
  return turning_m_per_s >= speed_m_per_s ? 1.0 : 0.5 * (1.0 - std::cos(std::numbers::pi * turning_m_per_s / speed_m_per_s));
}

Wheels cosines(const std::array<Direction, kMostWheels>& of) {
  return {of[0].cosine_ratio, of[1].cosine_ratio, of[2].cosine_ratio, of[3].cosine_ratio};
}
Wheels sines(const std::array<Direction, kMostWheels>& of) {
  return {of[0].sine_ratio, of[1].sine_ratio, of[2].sine_ratio, of[3].sine_ratio};
}

/// Returns |f(θ)| of each wheel, blended with the rotation constant.
Wheels heading_magnitudes_Nm(const HeadingFriction& heading, const WheelArrays& wheels, const BodyVelocity& local) {
  const double speed_m_per_s = std::sqrt(local.x_m_per_s * local.x_m_per_s + local.y_m_per_s * local.y_m_per_s);
  const double rotation = rotation_share(wheels.arm_m[0], local, speed_m_per_s);
  const double x = speed_m_per_s > 0.0 ? local.x_m_per_s / speed_m_per_s : 0.0;
  const double y = speed_m_per_s > 0.0 ? local.y_m_per_s / speed_m_per_s : 0.0;
  // sin and cos of θ + φ, φ the wheel's rolling direction
  const Wheels sine = wheels.rolling_x_share * x + wheels.rolling_y_share * y;
  const Wheels cosine = wheels.rolling_y_share * x - wheels.rolling_x_share * y;
  const Wheels s = (sine * cosines(heading.phase_offset) + cosine * sines(heading.phase_offset)).abs();
  // sin(2θ + ψ) of the unit vector (x, y)
  const Wheels twice = 2.0 * x * y * cosines(heading.double_angle_phase) + (x * x - y * y) * sines(heading.double_angle_phase);
  const Wheels translation_Nm = as_wheels(heading.constant_Nm) + as_wheels(heading.sine_Nm) * s + heading.double_angle_Nm * twice;
  return (1.0 - rotation) * translation_Nm + rotation * heading.rotation_Nm;
}

}  // namespace

Wheels dry_friction_Nm(const FrictionConfig& friction, const WheelArrays& wheels, const BodyVelocity& local) {
  return friction.by_heading ? heading_magnitudes_Nm(friction.heading, wheels, local) : Wheels::Constant(friction.wheel_torque_Nm);
}

double rolling_phase_rad(const WheelDirections& wheel) { return std::atan2(wheel.rolling_x_share, wheel.rolling_y_share); }

DriveConstants drive_constants(const Robot& robot, const motor::MotorValues& motor) {
  const MotorElectrics electrics = make_electrics(robot, motor);
  const double driver_ohm = robot.series_resistance_ohm();
  return {electrics.heating_factor * electrics.resistance_25C_ohm + driver_ohm, electrics.torque_constant_25C_Nm_per_A,
          electrics.drag_torque_Nm, robot.drive.gear_ratio, robot.drive.gear_efficiency};
}

double friction_torque_of_voltage_Nm(const DriveConstants& drive, double voltage_V) {
  const double motor_torque_Nm = voltage_V / drive.resistance_ohm * drive.torque_constant_Nm_per_A;
  return std::max(0.0, motor_torque_Nm - drive.drag_torque_Nm) * drive.gear_ratio * drive.gear_efficiency;
}

double damping_of_voltage_Nm_s_per_rad(const DriveConstants& drive, double damping_V_s_per_rad) {
  const double beyond_back_emf_V_s_per_rad = damping_V_s_per_rad / drive.gear_ratio - drive.torque_constant_Nm_per_A;
  return std::max(0.0, beyond_back_emf_V_s_per_rad) * drive.torque_constant_Nm_per_A / drive.resistance_ohm * drive.gear_ratio *
         drive.gear_ratio * drive.gear_efficiency;
}

double steady_voltage_V(const DriveConstants& drive, double wheel_torque_Nm, double wheel_speed_rad_per_s) {
  const double drag_Nm = wheel_speed_rad_per_s == 0.0 ? 0.0 : std::copysign(drive.drag_torque_Nm, wheel_speed_rad_per_s);
  const double motor_torque_Nm = wheel_torque_Nm / (drive.gear_ratio * drive.gear_efficiency) + drag_Nm;
  return motor_torque_Nm * drive.resistance_ohm / drive.torque_constant_Nm_per_A +
         drive.torque_constant_Nm_per_A * drive.gear_ratio * wheel_speed_rad_per_s;
}

}  // namespace heatsoak::robot
