// A robot as its file declares it: the loads, supply and limits of its motors.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/parameter.h"
#include "base/parameter_value.h"
#include "base/random.h"
#include "input/reader.h"
#include "motor/motor.h"

namespace heatsoak::robot {

/// Phase currents of the driver. For equal torque sinusoidal current gives 0.912 of the copper loss of block commutation: 0.75·R·Î²
/// relative to R·I², with K_t per peak ampere 0.907 of the one per DC ampere.
enum class Commutation { block, sinusoidal };

// The tables of a robot file. The meaning, unit and range of each value stand in its ParameterSpec in robot.cpp, and only there. Comments
// here state only conventions of the program. A value is empty if the file does not give it; simulations of motion need most of them,
// prescribed duties do not.

struct RobotWheels {
  double radius_m = 0.0;
  double contact_radius_m = 0.0;
  std::vector<double> axis_rad;     ///< one per wheel
  std::vector<double> slip_factor;  ///< one per wheel; no factors: not measured
  std::optional<double> inertia_kg_m2 = {};
};

struct RobotDrive {
  std::string motor;                                     ///< id of the motor that the robot is built with; "none" if no file describes it
  std::optional<std::filesystem::path> motor_file = {};  ///< absolute path of that motor's file if the robot names it by a path
  double gear_ratio = 1.0;
  double gear_efficiency = 1.0;
  std::optional<double> voltage_limit_V = {};
  std::optional<double> current_limit_A = {};
  Commutation commutation = Commutation::block;
  std::optional<double> driver_resistance_ohm = {};
  std::optional<double> driver_standby_W = {};
  std::optional<double> control_rate_Hz = {};
  std::optional<double> command_rate_Hz = {};

  /// Returns the name by which the motor's file is found: its path, or the id.
  [[nodiscard]] std::string motor_name() const { return motor_file ? motor_file->string() : motor; }
  /// Returns the part of a voltage from 0 V up that the driver applies.
  [[nodiscard]] double limited_V(double voltage_V) const;
  /// Returns the part of a current of either sign that the driver permits.
  [[nodiscard]] double limited_A(double current_A) const;
};

struct RobotBattery {
  double nominal_V = 0.0;
  std::optional<double> full_V = {};
  std::optional<double> empty_V = {};
  std::optional<double> resistance_ohm = {};
  std::optional<double> capacity_A_s = {};
};

struct RobotBody {
  std::optional<double> yaw_inertia_kg_m2 = {};
  std::optional<double> center_of_gravity_height_m = {};
  std::optional<double> center_of_gravity_x_m = {};  ///< 0 if empty
  std::optional<double> center_of_gravity_y_m = {};  ///< 0 if empty
};

/// Measured friction of one wheel over the direction of travel; friction.h has the formula.
struct HeadingWheel {
  double constant_Nm = 0.0;
  double sine_Nm = 0.0;
  double phase_rad = 0.0;
};

/// Measured friction curve over the direction of travel; friction.h has its formula.
struct RobotHeadingFriction {
  std::optional<double> constant_Nm = {};      ///< for all wheels; empty if each wheel has its own
  std::optional<double> sine_Nm = {};          ///< for all wheels; empty if each wheel has its own
  std::optional<double> double_angle_Nm = {};  ///< 0 if empty
  std::optional<double> rotation_Nm = {};      ///< equals wheel_torque_Nm if empty
  std::vector<double> double_angle_phase_rad;  ///< one per wheel; empty without the double-angle term
  std::vector<HeadingWheel> wheels;            ///< one per wheel, or none
};

struct RobotFriction {
  std::optional<double> wheel_torque_Nm = {};
  std::optional<double> wheel_damping_Nm_s_per_rad = {};
  std::optional<double> roller_drag_ratio = {};
  std::optional<double> rolling_efficiency = {};  ///< 1 if empty
  RobotHeadingFriction heading;
  bool is_assumed = false;  ///< set by with_assumed_friction(); the file states none
};

struct RobotTraction {
  std::optional<double> coefficient_ratio = {};
  std::optional<double> slip_speed_m_per_s = {};
};

/// Limits of the team's planner.
struct RobotLimits {
  std::optional<double> speed_m_per_s = {};
  std::optional<double> acceleration_m_per_s2 = {};
  std::optional<double> braking_m_per_s2 = {};
  std::optional<double> jerk_m_per_s3 = {};
  std::optional<double> yaw_rate_rad_per_s = {};
  std::optional<double> yaw_acceleration_rad_per_s2 = {};
};

struct Robot {
  std::string id;  ///< stem of the file name
  std::filesystem::path file;
  std::string name;
  std::string source;
  double mass_kg = 0.0;
  RobotWheels wheels;
  RobotDrive drive;
  RobotBattery battery;
  RobotBody body;
  RobotFriction friction;
  RobotTraction traction;
  RobotLimits limits;
  std::map<std::string, base::ParameterValue, std::less<>> parameters;  ///< by "table.key" or "friction.heading.wheel[0].key"

  // Copies and the destructor are large, so they are compiled once.
  Robot();
  Robot(const Robot&);
  Robot(Robot&&) noexcept;
  Robot& operator=(const Robot&);
  Robot& operator=(Robot&&) noexcept;
  ~Robot();

  [[nodiscard]] double available_V() const;
  /// Resistance between the battery and a motor's terminals in ohm; 0 if the file does not give it.
  [[nodiscard]] double series_resistance_ohm() const;
};

/// Access to a value in one of the tables that a robot file may omit.
struct RobotMember {
  std::optional<double>& (*of)(Robot&) = nullptr;
  const std::optional<double>& (*in)(const Robot&) = nullptr;

  constexpr RobotMember() = default;
  /// `member` is a generic lambda without captures: [](auto& robot) -> auto& { return robot.battery.full_V; }.
  template <class Member>
  constexpr RobotMember(Member member) : of(member), in(member) {}  // NOLINT(google-explicit-constructor): written in tables
};

/// Declaration of one robot parameter: its table, key, unit and range in the file, and the member that stores it.
struct RobotParameterSpec {
  std::string_view table;
  base::ParameterSpec spec;
  RobotMember value;
};
std::span<const RobotParameterSpec> robot_parameter_specs();

/// Declaration of one value of a [[friction.heading.wheel]].
struct WheelParameterSpec {
  base::ParameterSpec spec;
  double HeadingWheel::*value = nullptr;
};
std::span<const WheelParameterSpec> wheel_parameter_specs();

/// Throws Failure (bad_input) with every non-optional value of `tables` that the robot lacks.
void require_parameters(const Robot& robot, std::span<const std::string_view> tables);

/// Returns the robot with one random sample of every uncertain value.
Robot draw_sample(const Robot& robot, base::Random& random);

/// Reads a robot file. Throws Failure (bad_input) with every problem of the file.
Robot read_robot(const std::filesystem::path& path);

/// Like read_robot() for a text in memory; `path` names the robot.
Robot parse_robot(const std::string& text, const std::filesystem::path& path);

}  // namespace heatsoak::robot
