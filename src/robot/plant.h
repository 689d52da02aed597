// The robot that a controller drives: battery, drivers, motors, wheels that slip, body. Forward dynamics, step by step.
#pragma once

#include <array>

#include "robot/battery.h"
#include "robot/body.h"
#include "robot/driver.h"

namespace heatsoak {

struct PlantConfig {
  BodyConfig body;
  MotorElectrics motor;
  DriverConfig driver;
  BatteryConfig battery;
  double gear_ratio = 1.0;
  double gear_efficiency = 1.0;
  double period_s = 0.001;
};

/// Needs all tables of the robot's file but [limits]; throws Failure (bad_input) that names what is missing.
PlantConfig make_plant(const Robot& robot, const MotorValues& motor, double period_s);

struct PlantState {
  Pose pose;
  BodyVelocity velocity;  ///< of the origin, local axes
  PerWheel wheel_speed_rad_per_s{};
  double battery_charge_A_s = 0.0;
};

/// At rest at the field's centre with a full battery.
PlantState plant_at_rest(const PlantConfig& plant);

/// Held over the step.
struct PlantInput {
  std::array<MotorCommand, kMostWheels> command{};
  Wrench external;                 ///< on the body from outside, local axes
  double external_height_m = 0.0;  ///< above the ground, where it acts
  PerWheel winding_C{25.0, 25.0, 25.0, 25.0};
  PerWheel magnet_C{25.0, 25.0, 25.0, 25.0};
};

/// Means over the step. Where power goes, all ≥ 0 but what may flow both ways:
///   battery_source_W = battery_loss_W + Σ (driver + copper + motor_drag + gear + rolling + friction + slip + roller)
///                      + change of kinetic energy − external_W.
struct PlantOutput {
  PerWheel current_A{};
  PerWheel terminal_V{};
  PerWheel motor_torque_Nm{};  ///< K_t·I − drag, at the motor's shaft
  PerWheel motor_speed_rad_per_s{};
  PerWheel wheel_torque_Nm{};  ///< that the gear hands to the wheel
  PerWheel rolling_force_N{};  ///< on the contact, along the rolling direction
  PerWheel normal_force_N{};
  PerWheel slip_m_per_s{};  ///< rim minus ground, > 0 drives
  PerWheel copper_W{};
  PerWheel driver_W{};
  PerWheel motor_drag_W{};  ///< iron and bearings
  PerWheel gear_W{};
  PerWheel rolling_W{};   ///< by the rolling efficiency
  PerWheel friction_W{};  ///< wheel torque and damping
  PerWheel slip_W{};      ///< contact sliding along the rolling direction
  PerWheel roller_W{};    ///< drag along the axles
  double battery_V = 0.0;
  double battery_current_A = 0.0;  ///< > 0 discharges
  double battery_source_W = 0.0;   ///< what the cells give before their own loss
  double battery_loss_W = 0.0;
  double external_W = 0.0;    ///< done on the robot
  bool limited = false;       ///< a motor got less than its command
  bool lifted = false;        ///< a wheel has left the ground
  bool undervoltage = false;  ///< the battery broke down or is empty; the motors are switched off
};

/// The heat of all losses but the battery's own.
double heat_W(const PlantOutput& output);

/// One step of the period:
///   J·dω_i/dt = M_i·n·η_gear − friction_i − f_i·r·η_roll,  m, I: acceleration of Jᵀ·f + drag + external,
/// f and drag by contact_ratios() at the slip r·ω_i − t·v − R·yaw rate, loads from the forces themselves.
/// Method: ROS2 (Verwer, Spee, Blom, Hundsdorfer 1999), second order for any approximation of the Jacobian; here
/// that of the contacts and of what resists the wheels, because they are stiff. Powers are integrated by the same
/// method, so that the balance above closes to second order in the period. Currents and battery have settled.
/// All fields of `output` are overwritten.
void step(const PlantConfig& plant, PlantState& state, const PlantInput& input, PlantOutput& output);
PlantOutput step(const PlantConfig& plant, PlantState& state, const PlantInput& input);

}  // namespace heatsoak
