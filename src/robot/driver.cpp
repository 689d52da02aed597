#include "robot/driver.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "motor/datasheet_network.h"
#include "robot/motor_drive.h"
#include "robot/wheel_laws.h"

namespace heatsoak::robot {

DriverConfig make_driver(const Robot& robot) {
  DriverConfig driver;
  driver.voltage_limit_V = robot.drive.voltage_limit_V.value_or(driver.voltage_limit_V);
  driver.current_limit_A = robot.drive.current_limit_A.value_or(driver.current_limit_A);
  driver.resistance_ohm = robot.drive.driver_resistance_ohm.value();
  driver.standby_W = robot.drive.driver_standby_W.value();
  return driver;
}

MotorElectrics make_electrics(const Robot& robot, const motor::MotorValues& motor) {
  MotorElectrics made;
  made.resistance_25C_ohm = motor.terminal_resistance_ohm;
  made.resistance_rise_per_K = motor.temperature_coefficient_per_K;
  made.torque_constant_25C_Nm_per_A = motor.torque_constant_Nm_per_A;
  made.heating_factor = heating_factor(robot) * heating_factor(robot);
  made.drag_torque_Nm = motor::drag_torque_Nm(motor);
  return made;
}

bool is_limited(const DriverDemands& demands, const Wheels& limit_V, const Wheels& wanted_A, const Wheels& within_A,
                const Wheels& current_A) {
  bool limited = false;
  for (int i = 0; i < kMostWheels; ++i) {
    const bool is_voltage = demands.voltage_share[i] != 0.0;
    limited = limited || (is_voltage ? std::abs(demands.voltage_V[i]) > limit_V[i] || within_A[i] != wanted_A[i]
                                     : std::abs(current_A[i] - wanted_A[i]) > 1e-9 * std::abs(wanted_A[i]));
  }
  return limited;
}

MotorPoint motor_point(const MotorElectrics& motor, const DriverConfig& driver, const MotorCommand& command, double motor_speed_rad_per_s,
                       double winding_C, double magnet_C, double bus_V) {
  const MotorCircuits circuits = motor_circuits(motor, driver, Wheels::Constant(winding_C), Wheels::Constant(magnet_C));
  MotorPoint point;
  point.torque_constant_Nm_per_A = circuits.torque_constant_Nm_per_A[0];
  point.resistance_ohm = circuits.resistance_ohm[0];
  const Wheels back_emf_V = circuits.torque_constant_Nm_per_A * motor_speed_rad_per_s;
  const MotorCurrents currents = motor_currents(circuits, driver_demands(driver, {command}, 1), back_emf_V, bus_V);
  point.limited = currents.limited;
  point.current_A = currents.current_A[0];
  point.bridge_V = currents.bridge_V[0];
  const double square_A2 = point.current_A * point.current_A;
  point.copper_W = circuits.winding_ohm[0] * square_A2;
  point.driver_W = driver.resistance_ohm * square_A2 + driver.standby_W;
  point.terminal_V = point.bridge_V - driver.resistance_ohm * point.current_A;
  point.input_W = point.bridge_V * point.current_A + driver.standby_W;
  return point;
}

}  // namespace heatsoak::robot
