// One motor on its driver: from a command to current and powers.
#pragma once

#include <limits>

#include "motor/motor.h"
#include "robot/robot.h"

namespace heatsoak {

/// Currents are equivalent DC currents of block commutation, voltages between two terminals (as in MotorValues).
struct DriverConfig {
  double voltage_limit_V = std::numeric_limits<double>::infinity();  ///< of the command
  double current_limit_A = std::numeric_limits<double>::infinity();
  double resistance_ohm = 0.0;  ///< in series with the winding
  double standby_W = 0.0;       ///< always
};

struct MotorElectrics {
  double resistance_25C_ohm = 1.0;
  double resistance_rise_per_K = 0.0039;
  double torque_constant_25C_Nm_per_A = 0.0;
  /// Magnets weaken with heat: K_t·(1 − β·(T − 25 °C)); NdFeB has about 0.0011 /K. A data sheet gives none, so 0.
  double torque_constant_fall_per_K = 0.0;
  double heating_factor = 1.0;  ///< copper loss per R·I²: 0.912 where the current is sinusoidal
  double drag_torque_Nm = 0.0;  ///< iron and bearings, K_t·I_0, at the motor
};
DriverConfig make_driver(const Robot& robot);
MotorElectrics make_electrics(const Robot& robot, const MotorValues& motor);

struct MotorCommand {
  enum class Kind { voltage, current, open };
  Kind kind = Kind::open;
  double value = 0.0;  ///< V or A; an open motor has no current
};

struct MotorPoint {
  double current_A = 0.0;
  double bridge_V = 0.0;    ///< mean voltage that the switches put out
  double terminal_V = 0.0;  ///< what arrives at the motor
  double torque_constant_Nm_per_A = 0.0;
  double resistance_ohm = 0.0;  ///< that turns current into heat, winding and driver
  double copper_W = 0.0;
  double driver_W = 0.0;  ///< conduction and standby
  double input_W = 0.0;   ///< from the bus: bridge_V·I + standby; < 0 gives back
  bool limited = false;   ///< by the bus, the command's clamp or the current limit
};

/// The current has settled (its time constant L/R is below a millisecond): I = (U − K_t·ω)/(R(T)·k + R_driver), k the
/// heating factor, so that U·I = copper + driver conduction + K_t·ω·I holds to rounding.
/// |U| ≤ min(bus, voltage limit), |I| ≤ current limit.
MotorPoint motor_point(const MotorElectrics& motor, const DriverConfig& driver, const MotorCommand& command, double motor_speed_rad_per_s,
                       double winding_C, double magnet_C, double bus_V);

}  // namespace heatsoak
