// From what a wheel must do to what its motor gets: torque and speed to current, within the limits of voltage
// and current.
#pragma once

#include "motor/datasheet_network.h"
#include "motor/motor.h"
#include "robot/robot.h"
#include "thermal/effect.h"
#include "thermal/scalar.h"

namespace heatsoak {

/// Demand on one wheel. Torque and speed are positive in the same direction; torque · speed > 0 drives.
struct WheelLoad {
  double torque_Nm = 0.0;
  double speed_rad_per_s = 0.0;
};

/// What cuts the current: nothing, the available voltage (at 25 °C), or the driver's current limit.
enum class DriveLimit { none, voltage, current };

struct DrivePoint {
  double current_A = 0.0;  ///< that flows, equivalent DC current of block commutation, signed like the torque
  double current_wanted_A = 0.0;
  double motor_speed_rad_per_s = 0.0;
  double motor_torque_Nm = 0.0;  ///< at the shaft, of the current that flows
  DriveLimit limit = DriveLimit::none;
};

/// Current for a motor torque at a speed: (M + K_t·I_0·sign ω)/K_t, so that drag helps when braking; clamped to
/// |I| ≤ current limit and to |I·(R25 + R_driver) + K_t·ω| ≤ available voltage; 0 where the back-EMF alone is more than that.
/// The cold resistance lets more current through than a hot winding would: the error is on the hot side.
DrivePoint drive_point(const MotorValues& motor, const Robot& robot, const WheelLoad& load);

/// The same for a prescribed current, which is clamped too.
DrivePoint drive_point_of_current(const MotorValues& motor, const Robot& robot, double current_A, double wheel_speed_rad_per_s);

/// A current at a motor speed, clamped to what the driver and the available voltage let through.
DrivePoint clamped_point(const MotorValues& motor, const Robot& robot, double wanted_A, double motor_speed_rad_per_s);

/// Motor torque per wheel torque: a gear loses torque on the way to the wheel when driving, on the way back when braking.
double shaft_torque_factor(const Robot& robot, bool drives);

/// Terminal voltage that the point needs with the winding at a temperature; signed like the torque.
double terminal_voltage_V(const MotorValues& motor, const DrivePoint& point, double winding_C);

/// The driver's voltage for it: what the switches and traces take is added.
double driver_voltage_V(const MotorValues& motor, const Robot& robot, const DrivePoint& point, double winding_C);

/// Current that heats as much through the terminal resistance, per current that makes the torque.
double heating_factor(const Robot& robot);

/// Electrical power into the motor: copper loss at 25 °C, drag and what leaves at the shaft. `speed_rad_per_s` is |ω|.
template <class S>
S input_power_W(const MotorValues& motor, const S& heating_current_A, const S& shaft_power_W, const S& speed_rad_per_s) {
  return heating_current_A * heating_current_A * motor.terminal_resistance_ohm + shaft_power_W + drag_torque_Nm(motor) * speed_rad_per_s;
}

/// What of an operating point follows from current and speed alone, for numbers and for formulas: no headroom, no vehicle.
/// `current_A` and `velocity_rad_per_s` have the same sign where the motor drives.
template <class S>
OperatingPoint<S> machine_point(const MotorValues& motor, const Robot& robot, const S& current_A, const S& velocity_rad_per_s,
                                const S& shaft_power_W) {
  OperatingPoint<S> at;
  at.current_rms_A = magnitude(current_A) * heating_factor(robot);
  at.speed_mean_rad_per_s = magnitude(velocity_rad_per_s);
  at.speed_rms_rad_per_s = at.speed_mean_rad_per_s;
  at.velocity_rad_per_s = velocity_rad_per_s;
  at.shaft_power_W = shaft_power_W;
  at.input_power_W = input_power_W(motor, at.current_rms_A, shaft_power_W, at.speed_mean_rad_per_s);
  at.bus_V = robot.battery_V;
  const S terminal_V = current_A * motor.terminal_resistance_ohm + motor.torque_constant_Nm_per_A * velocity_rad_per_s;
  const S modulation_ratio = magnitude(terminal_V + current_A * robot.series_resistance_ohm()) / robot.battery_V;
  at.modulation_ratio = modulation_ratio - positive_part(modulation_ratio - 1.0);
  return at;
}

/// What the thermal network sees of it. Voltage and input power are those of a winding at 25 °C; the vehicle is as fast as
/// the wheel rolls, an estimate where wheels stand askew. Nothing is known of neighbours, and the motor is new.
OperatingPoint<double> operating_point(const DrivePoint& point, const MotorValues& motor, const Robot& robot, double ambient_C);

}  // namespace heatsoak
