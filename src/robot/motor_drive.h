// Converts torque and speed of a wheel to the current of its motor, within the voltage and current limits.
#pragma once

#include "motor/motor.h"
#include "robot/robot.h"
#include "thermal/operating_point.h"

namespace heatsoak::robot {

/// Demand on one wheel. Torque and speed are positive in the same direction; torque · speed > 0 is driving.
struct WheelLoad {
  double torque_Nm = 0.0;
  double speed_rad_per_s = 0.0;
};

/// Limit that determines the current: none, the available voltage (with a winding at 25 °C), or the driver's current limit.
enum class DriveLimit { none, voltage, current };

/// Operating point of a motor after the limits.
struct DrivePoint {
  double current_A = 0.0;  ///< after limits; equivalent DC current of block commutation, with the sign of the torque
  double current_wanted_A = 0.0;
  double motor_speed_rad_per_s = 0.0;
  double motor_torque_Nm = 0.0;  ///< at the shaft, from current_A
  DriveLimit limit = DriveLimit::none;
};

/// Returns the point for a wheel torque at a speed, with the current (M + K_t·I_0·sign ω)/K_t, so that drag helps when braking. It is
/// limited to |I| ≤ current limit and |I·(R25 + R_driver) + K_t·ω| ≤ available voltage; 0 if the back-EMF alone exceeds the voltage. The
/// cold resistance allows more current than a hot winding would, so temperatures are overestimated.
DrivePoint drive_point(const motor::MotorValues& motor, const Robot& robot, const WheelLoad& load);

/// Returns the point for a prescribed current at a wheel speed; the current is limited in the same way.
DrivePoint drive_point_of_current(const motor::MotorValues& motor, const Robot& robot, double current_A, double wheel_speed_rad_per_s);

/// Returns the point for a current at a motor speed; the current is limited in the same way.
DrivePoint clamped_point(const motor::MotorValues& motor, const Robot& robot, double wanted_A, double motor_speed_rad_per_s);

/// Returns motor torque per wheel torque: 1/(η·ratio) when driving, η/ratio when braking.
double shaft_torque_factor(const Robot& robot, bool drives);

/// Returns the terminal voltage of the point for a winding temperature, with the sign of the torque.
double terminal_voltage_V(const motor::MotorValues& motor, const DrivePoint& point, double winding_C);

/// Returns the driver's voltage for the point: the terminal voltage plus the drop across the series resistance.
double driver_voltage_V(const motor::MotorValues& motor, const Robot& robot, const DrivePoint& point, double winding_C);

/// Returns the equivalent heating current per torque-producing current: 1 for block commutation, 3/π for sinusoidal.
double heating_factor(const Robot& robot);

/// Returns the operating point for the thermal network. Voltage and input power assume a winding at 25 °C. The vehicle speed is the rolling
/// speed of the wheel, an estimate for wheels at an angle. Neighbours are unknown, and the motor is new.
thermal::OperatingPoint<double> operating_point(const DrivePoint& point, const motor::MotorValues& motor, const Robot& robot,
                                                double ambient_C);

}  // namespace heatsoak::robot
