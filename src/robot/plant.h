// Simulated robot for a controller: battery, drivers, motors, slipping wheels, body. Forward dynamics with a fixed step.
#pragma once

#include <array>

#include "robot/battery.h"
#include "robot/body.h"
#include "robot/driver.h"

namespace heatsoak::robot {

/// Constants of the simulated robot.
struct PlantConfig {
  BodyConfig body;
  MotorElectrics motor;
  DriverConfig driver;
  BatteryConfig battery;
  double gear_ratio = 1.0;
  double gear_efficiency = 1.0;
  double period_s = 0.001;
};

/// Builds the plant from all tables of the robot's file except [limits]. Throws Failure (bad_input) with the missing values.
PlantConfig make_plant(const Robot& robot, const motor::MotorValues& motor, double period_s);

struct PlantState {
  Pose pose;
  BodyVelocity velocity;  ///< velocity of the origin, local axes
  PerWheel wheel_speed_rad_per_s{};
  double battery_charge_A_s = 0.0;
};

/// Returns the state at rest at the field's centre with a full battery.
PlantState plant_at_rest(const PlantConfig& plant);

/// Input, constant over the step.
struct PlantInput {
  std::array<MotorCommand, kMostWheels> command{};
  Wrench external;                 ///< wrench on the body from outside, local axes
  double external_height_m = 0.0;  ///< height above the ground at which it acts
  PerWheel winding_C{25.0, 25.0, 25.0, 25.0};
  PerWheel magnet_C{25.0, 25.0, 25.0, 25.0};
};

/// Means over the step. Powers are ≥ 0 except those that can flow both ways. Energy balance:
///   battery_source_W = battery_loss_W + Σ (driver + copper + motor_drag + gear + rolling + friction + slip + roller)
///                      + change of kinetic energy − external_W.
struct PlantOutput {
  PerWheel current_A{};
  PerWheel terminal_V{};
  PerWheel motor_torque_Nm{};  ///< K_t·I − drag, at the motor's shaft
  PerWheel motor_speed_rad_per_s{};
  PerWheel wheel_torque_Nm{};  ///< from the gear to the wheel
  PerWheel rolling_force_N{};  ///< force on the contact along the rolling direction
  PerWheel normal_force_N{};
  PerWheel slip_m_per_s{};  ///< rim speed minus ground speed; > 0 drives
  PerWheel copper_W{};
  PerWheel driver_W{};
  PerWheel motor_drag_W{};  ///< iron and bearing loss
  PerWheel gear_W{};
  PerWheel rolling_W{};   ///< rolling loss by the rolling efficiency
  PerWheel friction_W{};  ///< wheel friction torque and damping
  PerWheel slip_W{};      ///< sliding along the rolling direction
  PerWheel roller_W{};    ///< roller drag along the axles
  double battery_V = 0.0;
  double battery_current_A = 0.0;  ///< positive when discharging
  double battery_source_W = 0.0;   ///< power of the ideal source, before the internal loss
  double battery_loss_W = 0.0;
  double external_W = 0.0;    ///< power of the external wrench on the robot
  bool limited = false;       ///< a motor got less than its command
  bool lifted = false;        ///< a wheel has left the ground
  bool undervoltage = false;  ///< the battery voltage collapsed or the battery is empty; the motors are off
};

/// Returns the heat of all losses except the battery's own, in W.
double heat_W(const PlantOutput& output);

/// One step of the period:
///   J·dω_i/dt = M_i·n·η_gear − friction_i − f_i·r·η_roll; the body is accelerated by Jᵀ·f + drag + external.
/// f and drag follow from contact_ratios() at the slip r·ω_i − t·v − R·yaw rate, the normal loads from these forces.
/// Method: ROS2 (Verwer, Spee, Blom, Hundsdorfer 1999), second order for any approximate Jacobian. The Jacobian contains only the stiff
/// terms: contacts, and friction and motor torque of the wheels. Powers are integrated by the same method, so that the balance above closes
/// to second order in the period. Currents and battery are in steady state. All fields of `output` are overwritten.
void step(const PlantConfig& plant, PlantState& state, const PlantInput& input, PlantOutput& output);
PlantOutput step(const PlantConfig& plant, PlantState& state, const PlantInput& input);

}  // namespace heatsoak::robot
