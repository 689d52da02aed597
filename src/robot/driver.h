// One motor on its driver: converts a command to current and powers.
#pragma once

#include <array>
#include <limits>

#include "motor/motor.h"
#include "robot/kinematics.h"

namespace heatsoak::robot {

/// Currents are equivalent DC currents of block commutation, voltages between two terminals (as in MotorValues).
struct DriverConfig {
  // Infinite without a limit: the laws of all wheels compare with them in every step.
  double voltage_limit_V = std::numeric_limits<double>::infinity();  ///< limit of the commanded voltage
  double current_limit_A = std::numeric_limits<double>::infinity();
  double resistance_ohm = 0.0;  ///< in series with the winding
  double standby_W = 0.0;       ///< constant power of the electronics
};

/// Electrical constants of a motor, at 25 °C and over temperature.
struct MotorElectrics {
  double resistance_25C_ohm = 1.0;
  double resistance_rise_per_K = 0.0039;
  double torque_constant_25C_Nm_per_A = 0.0;
  /// Reversible loss of the magnets: K_t·(1 − β·(T − 25 °C)); NdFeB about 0.0011 1/K. Data sheets do not give it, so the default is 0.
  double torque_constant_fall_per_K = 0.0;
  double heating_factor = 1.0;  ///< copper loss per R·I²: 0.912 for sinusoidal current
  double drag_torque_Nm = 0.0;  ///< iron and bearing loss, K_t·I_0, at the motor
};
/// Returns the driver of one motor. The robot's file must give driver_resistance and driver_standby.
DriverConfig make_driver(const Robot& robot);
/// Returns the electrical constants of the motor for the driver's commutation.
MotorElectrics make_electrics(const Robot& robot, const motor::MotorValues& motor);

/// Command to the driver of one motor.
struct MotorCommand {
  enum class Kind { voltage, current, open };
  Kind kind = Kind::open;
  double value = 0.0;  ///< V or A; ignored for an open motor, which has no current
};

/// Operating point of one motor on its driver.
struct MotorPoint {
  double current_A = 0.0;
  double bridge_V = 0.0;    ///< mean output voltage of the bridge
  double terminal_V = 0.0;  ///< voltage at the motor terminals
  double torque_constant_Nm_per_A = 0.0;
  double resistance_ohm = 0.0;  ///< winding (with heating factor) plus driver
  double copper_W = 0.0;
  double driver_W = 0.0;  ///< conduction loss and standby
  double input_W = 0.0;   ///< power from the bus, bridge_V·I + standby; negative when feeding back
  bool limited = false;   ///< true if the bus voltage, the limit of the command or the current limit acts
};

/// Returns the operating point of a single motor as motor_currents() (wheel_laws.h) does, with its powers.
MotorPoint motor_point(const MotorElectrics& motor, const DriverConfig& driver, const MotorCommand& command, double motor_speed_rad_per_s,
                       double winding_C, double magnet_C, double bus_V);

}  // namespace heatsoak::robot
