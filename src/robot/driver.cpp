#include "robot/driver.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "motor/datasheet_network.h"
#include "robot/motor_drive.h"
#include "thermal/copper.h"

namespace heatsoak {

DriverConfig make_driver(const Robot& robot) {
  return {robot.voltage_limit_V, robot.current_limit_A, robot.driver_resistance_ohm, robot.driver_standby_W};
}

MotorElectrics make_electrics(const Robot& robot, const MotorValues& motor) {
  MotorElectrics made;
  made.resistance_25C_ohm = motor.terminal_resistance_ohm;
  made.resistance_rise_per_K = motor.temperature_coefficient_per_K;
  made.torque_constant_25C_Nm_per_A = motor.torque_constant_Nm_per_A;
  made.heating_factor = heating_factor(robot) * heating_factor(robot);
  made.drag_torque_Nm = drag_torque_Nm(motor);
  return made;
}

MotorPoint motor_point(const MotorElectrics& motor, const DriverConfig& driver, const MotorCommand& command, double motor_speed_rad_per_s,
                       double winding_C, double magnet_C, double bus_V) {
  MotorPoint point;
  point.torque_constant_Nm_per_A =
      motor.torque_constant_25C_Nm_per_A * (1.0 - motor.torque_constant_fall_per_K * (magnet_C - kSheetTemperature_C));
  const double winding_ohm = motor.heating_factor * motor.resistance_25C_ohm * resistance_ratio(motor.resistance_rise_per_K, winding_C);
  point.resistance_ohm = winding_ohm + driver.resistance_ohm;
  const double back_emf_V = point.torque_constant_Nm_per_A * motor_speed_rad_per_s;
  if (command.kind != MotorCommand::Kind::open) {
    const double limit_V = std::min(bus_V, driver.voltage_limit_V);
    const bool is_current = command.kind == MotorCommand::Kind::current;
    const double wanted_A = is_current ? command.value : (std::clamp(command.value, -limit_V, limit_V) - back_emf_V) / point.resistance_ohm;
    const double within_A = std::clamp(wanted_A, -driver.current_limit_A, driver.current_limit_A);
    point.bridge_V = std::clamp(within_A * point.resistance_ohm + back_emf_V, -limit_V, limit_V);
    point.current_A = (point.bridge_V - back_emf_V) / point.resistance_ohm;
    point.limited = is_current ? std::abs(point.current_A - wanted_A) > 1e-9 * std::abs(wanted_A)
                               : std::abs(command.value) > limit_V || within_A != wanted_A;
  } else {
    point.bridge_V = back_emf_V;
  }
  const double square_A2 = point.current_A * point.current_A;
  point.copper_W = winding_ohm * square_A2;
  point.driver_W = driver.resistance_ohm * square_A2 + driver.standby_W;
  point.terminal_V = point.bridge_V - driver.resistance_ohm * point.current_A;
  point.input_W = point.bridge_V * point.current_A + driver.standby_W;
  return point;
}

}  // namespace heatsoak
