// A robot as its file declares it: the loads, supply and limits of its motors.
#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/parameter.h"
#include "base/parameter_value.h"
#include "base/random.h"
#include "input/reader.h"
#include "motor/motor.h"

namespace heatsoak {

/// Phase currents of the driver. For equal torque sinusoidal current gives 0.912 of the copper loss of block commutation: 0.75·R·Î²
/// relative to R·I², with K_t per peak ampere 0.907 of the one per DC ampere.
enum class Commutation { block, sinusoidal };

/// Measured friction of one wheel over the direction of travel; friction.h has the formula.
struct HeadingWheel {
  double constant_Nm = kAbsent;
  double sine_Nm = kAbsent;
  double phase_rad = kAbsent;
};

struct Robot {
  std::string id;  ///< stem of the file name
  std::filesystem::path file;
  std::string name;
  std::string drive_motor;  ///< id of the motor that it is built with
  std::string source;
  double wheel_radius_m = 0.0;
  double gear_ratio = 1.0;  ///< motor turns per wheel turn
  double gear_efficiency = 1.0;
  double battery_V = 0.0;                                            ///< nominal
  double voltage_limit_V = std::numeric_limits<double>::infinity();  ///< limit of the driver's command, per motor
  double current_limit_A = std::numeric_limits<double>::infinity();  ///< equivalent DC current, per motor
  Commutation commutation = Commutation::block;
  double mass_kg = 0.0;
  double wheel_contact_radius_m = 0.0;  ///< from the robot's axis to the wheels' contact points
  std::vector<double> wheel_axis_rad;   ///< direction of each wheel's axle from straight ahead, counter-clockwise, wheel 1 first

  // Values with origin; kAbsent if the file does not give them. Simulations of motion need them, prescribed duties do not.
  double yaw_inertia_kg_m2 = kAbsent;  ///< about the vertical axis through the centre of gravity, wheels included
  double center_of_gravity_height_m = kAbsent;
  double center_of_gravity_x_m = kAbsent;     ///< ahead of the robot's axis; 0 if absent
  double center_of_gravity_y_m = kAbsent;     ///< left of the robot's axis; 0 if absent
  double wheel_inertia_kg_m2 = kAbsent;       ///< one wheel about its axle, without the motor's rotor
  double wheel_friction_torque_Nm = kAbsent;  ///< at the wheel, without the motor's own drag
  double wheel_damping_Nm_s_per_rad = kAbsent;
  double roller_drag_ratio = kAbsent;      ///< drag force along the axle per normal force
  double rolling_efficiency = kAbsent;     ///< share of the wheel's torque that reaches the ground; 1 if absent
  double traction_ratio = kAbsent;         ///< largest rolling force per normal force
  double slip_speed_m_per_s = kAbsent;     ///< slip at which 0.71 of the largest rolling force is used
  double driver_resistance_ohm = kAbsent;  ///< switches and traces of one motor, in series with the winding
  double driver_standby_W = kAbsent;       ///< per motor: gate drive, logic, switching
  double control_rate_Hz = kAbsent;        ///< rate of the firmware's commands to the motors
  double command_rate_Hz = kAbsent;        ///< rate of the team computer's commands to the robot
  double battery_full_V = kAbsent;
  double battery_empty_V = kAbsent;
  double battery_resistance_ohm = kAbsent;
  double battery_capacity_A_s = kAbsent;
  double speed_limit_m_per_s = kAbsent;  ///< limit of the team's planner, like those below
  double acceleration_limit_m_per_s2 = kAbsent;
  double braking_limit_m_per_s2 = kAbsent;
  double jerk_limit_m_per_s3 = kAbsent;
  double yaw_rate_limit_rad_per_s = kAbsent;
  double yaw_acceleration_limit_rad_per_s2 = kAbsent;
  // Measured friction curve over the direction of travel; friction.h has its formula.
  double heading_constant_Nm = kAbsent;  ///< for all wheels; absent if each wheel has its own
  double heading_sine_Nm = kAbsent;
  double heading_double_angle_Nm = kAbsent;                       ///< 0 if absent
  double heading_rotation_Nm = kAbsent;                           ///< equals wheel_friction_torque if absent
  std::vector<double> heading_double_angle_phase_rad;             ///< per wheel; empty without the double-angle term
  std::vector<HeadingWheel> heading_wheels;                       ///< one per wheel, or none
  std::map<std::string, ParameterValue, std::less<>> parameters;  ///< by "table.key" or "friction.heading.wheel[0].key"
  bool is_friction_assumed = false;                               ///< set by with_assumed_friction(); the file states none

  [[nodiscard]] double available_V() const;
  /// Resistance between the battery and a motor's terminals in ohm; 0 if the file does not give it.
  [[nodiscard]] double series_resistance_ohm() const;
};

/// Declaration of one robot parameter: its table, key, unit and range in the file, and the member that stores it.
struct RobotParameterSpec {
  std::string_view table;
  ParameterSpec spec;
  double Robot::*value = nullptr;
};
std::span<const RobotParameterSpec> robot_parameter_specs();

/// The same for the values of one [[friction.heading.wheel]].
struct WheelParameterSpec {
  ParameterSpec spec;
  double HeadingWheel::*value = nullptr;
};
std::span<const WheelParameterSpec> wheel_parameter_specs();

/// Throws Failure (bad_input) with every non-optional value of `tables` that the robot lacks.
void require_parameters(const Robot& robot, std::span<const std::string_view> tables);

/// Returns the robot with one random sample of every uncertain value.
Robot draw_sample(const Robot& robot, Random& random);

/// Throws Failure (bad_input) with every problem of the file.
Robot read_robot(const std::filesystem::path& path);

/// Like read_robot() for a text in memory; `path` names the robot.
Robot parse_robot(const std::string& text, const std::filesystem::path& path);

}  // namespace heatsoak
