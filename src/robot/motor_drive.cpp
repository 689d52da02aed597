#include "robot/motor_drive.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/copper.h"
#include "robot/machine_point.h"
#include "thermal/lanes.h"
#include "thermal/traced.h"

namespace heatsoak::robot {
namespace {

double sign(double x) { return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0; }

}  // namespace

double shaft_torque_factor(const Robot& robot, bool drives) {
  return (drives ? 1.0 / robot.drive.gear_efficiency : robot.drive.gear_efficiency) / robot.drive.gear_ratio;
}

DrivePoint clamped_point(const motor::MotorValues& motor, const Robot& robot, double wanted_A, double motor_speed_rad_per_s) {
  DrivePoint point;
  point.current_wanted_A = wanted_A;
  point.motor_speed_rad_per_s = motor_speed_rad_per_s;
  const double back_emf_V = motor.torque_constant_Nm_per_A * motor_speed_rad_per_s;
  const double loop_ohm = motor.terminal_resistance_ohm + robot.series_resistance_ohm();
  // A back-EMF above the supply voltage makes the demand impossible, but does not reverse the current.
  const double most_A = std::max(0.0, (robot.available_V() - back_emf_V) / loop_ohm);
  const double least_A = std::min(0.0, (-robot.available_V() - back_emf_V) / loop_ohm);
  point.current_A = robot.drive.limited_A(wanted_A);
  if (point.current_A != wanted_A) {
    point.limit = DriveLimit::current;
  }
  const double within_voltage_A = std::clamp(point.current_A, least_A, most_A);
  if (within_voltage_A != point.current_A) {
    point.limit = DriveLimit::voltage;
    point.current_A = within_voltage_A;
  }
  point.motor_torque_Nm = motor.torque_constant_Nm_per_A * point.current_A - motor::drag_torque_Nm(motor) * sign(motor_speed_rad_per_s);
  return point;
}

DrivePoint drive_point(const motor::MotorValues& motor, const Robot& robot, const WheelLoad& load) {
  const double motor_torque_Nm = load.torque_Nm * shaft_torque_factor(robot, load.torque_Nm * load.speed_rad_per_s >= 0.0);
  const double motor_speed_rad_per_s = load.speed_rad_per_s * robot.drive.gear_ratio;
  const double wanted_A = (motor_torque_Nm + motor::drag_torque_Nm(motor) * sign(motor_speed_rad_per_s)) / motor.torque_constant_Nm_per_A;
  return clamped_point(motor, robot, wanted_A, motor_speed_rad_per_s);
}

DrivePoint drive_point_of_current(const motor::MotorValues& motor, const Robot& robot, double current_A, double wheel_speed_rad_per_s) {
  return clamped_point(motor, robot, current_A, wheel_speed_rad_per_s * robot.drive.gear_ratio);
}

double terminal_voltage_V(const motor::MotorValues& motor, const DrivePoint& point, double winding_C) {
  const double resistance_ohm = motor.terminal_resistance_ohm * base::resistance_ratio(motor.temperature_coefficient_per_K, winding_C);
  return point.current_A * resistance_ohm + motor.torque_constant_Nm_per_A * point.motor_speed_rad_per_s;
}

double driver_voltage_V(const motor::MotorValues& motor, const Robot& robot, const DrivePoint& point, double winding_C) {
  return terminal_voltage_V(motor, point, winding_C) + point.current_A * robot.series_resistance_ohm();
}

double heating_factor(const Robot& robot) {
  // 0.75·R·Î² relative to R·I² at equal torque, with Î = I/(√3·π/6), is (3/π)².
  return robot.drive.commutation == Commutation::sinusoidal ? 3.0 / std::numbers::pi : 1.0;
}

template <class S>
S input_power_W(const motor::MotorValues& motor, const S& heating_current_A, const S& shaft_power_W, const S& speed_rad_per_s) {
  const S squared_A2 = thermal::named("heating_current_squared_A2", heating_current_A * heating_current_A);
  return squared_A2 * motor.terminal_resistance_ohm + shaft_power_W + motor::drag_torque_Nm(motor) * speed_rad_per_s;
}

template <class S>
thermal::OperatingPoint<S> machine_point(const motor::MotorValues& motor, const Robot& robot, const S& current_A,
                                         const S& velocity_rad_per_s, const S& shaft_power_W) {
  thermal::OperatingPoint<S> at;
  using thermal::named;
  at.current_rms_A = named("heating_current_A", thermal::magnitude(current_A) * heating_factor(robot));
  at.speed_mean_rad_per_s = named("speed_magnitude_rad_per_s", thermal::magnitude(velocity_rad_per_s));
  at.speed_rms_rad_per_s = at.speed_mean_rad_per_s;
  at.velocity_rad_per_s = velocity_rad_per_s;
  at.shaft_power_W = shaft_power_W;
  at.input_power_W = named("input_power_W", input_power_W(motor, at.current_rms_A, shaft_power_W, at.speed_mean_rad_per_s));
  at.bus_V = robot.battery.nominal_V;
  const S terminal_V = current_A * motor.terminal_resistance_ohm + motor.torque_constant_Nm_per_A * velocity_rad_per_s;
  const S driver_V = named("driver_voltage_V", terminal_V + current_A * robot.series_resistance_ohm());
  const S needed = named("needed_voltage_ratio", thermal::magnitude(driver_V) / robot.battery.nominal_V);
  const S missing = named("missing_voltage_ratio", thermal::positive_part(named("needed_voltage_minus_one_ratio", needed - 1.0)));
  at.modulation_ratio = named("modulation_ratio", needed - missing);
  return at;
}

template double input_power_W<double>(const motor::MotorValues&, const double&, const double&, const double&);
template thermal::OperatingPoint<double> machine_point<double>(const motor::MotorValues&, const Robot&, const double&, const double&,
                                                               const double&);
template thermal::Lanes input_power_W<thermal::Lanes>(const motor::MotorValues&, const thermal::Lanes&, const thermal::Lanes&,
                                                      const thermal::Lanes&);
template thermal::OperatingPoint<thermal::Lanes> machine_point<thermal::Lanes>(const motor::MotorValues&, const Robot&,
                                                                               const thermal::Lanes&, const thermal::Lanes&,
                                                                               const thermal::Lanes&);
template thermal::Traced input_power_W<thermal::Traced>(const motor::MotorValues&, const thermal::Traced&, const thermal::Traced&,
                                                        const thermal::Traced&);
template thermal::OperatingPoint<thermal::Traced> machine_point<thermal::Traced>(const motor::MotorValues&, const Robot&,
                                                                                 const thermal::Traced&, const thermal::Traced&,
                                                                                 const thermal::Traced&);

thermal::OperatingPoint<double> operating_point(const DrivePoint& point, const motor::MotorValues& motor, const Robot& robot,
                                                double ambient_C) {
  const double speed_rad_per_s = std::abs(point.motor_speed_rad_per_s);
  // The back-EMF opposes the supply when driving and supports it when braking.
  const double back_emf_V =
      motor.torque_constant_Nm_per_A * speed_rad_per_s * (point.current_A * point.motor_speed_rad_per_s >= 0.0 ? 1.0 : -1.0);
  thermal::OperatingPoint<double> at = machine_point<double>(motor, robot, point.current_A, point.motor_speed_rad_per_s,
                                                             point.motor_torque_Nm * point.motor_speed_rad_per_s);
  at.ambient_C = ambient_C;
  at.resistive_headroom_V = std::max(0.0, robot.available_V() - back_emf_V) * heating_factor(robot);
  at.series_resistance_ohm = robot.series_resistance_ohm();
  at.vehicle_speed_m_per_s = speed_rad_per_s / robot.drive.gear_ratio * robot.wheels.radius_m;
  return at;
}

}  // namespace heatsoak::robot
