// A robot as its file declares it: what carries the motor, feeds it and limits it.
#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/figure.h"
#include "base/parameter.h"
#include "base/random.h"
#include "input/reader.h"
#include "motor/motor.h"

namespace heatsoak {

/// How the driver feeds the three phases. For equal torque a sinusoidal current heats 0.912 as much as block
/// commutation: 0.75·R·Î² against R·I², with K_t per peak ampere 0.907 of the one per DC ampere.
enum class Commutation { block, sinusoidal };

/// Friction of one wheel over the direction of travel as it was measured; friction.h has the formula.
struct HeadingWheel {
  double constant_Nm = kAbsent;
  double sine_Nm = kAbsent;
  double phase_rad = kAbsent;
};

struct Robot {
  std::string id;  ///< the file's stem
  std::filesystem::path file;
  std::string name;
  std::string drive_motor;  ///< id of the motor it is built with
  std::string source;
  double wheel_radius_m = 0.0;
  double gear_ratio = 1.0;  ///< motor turns per wheel turn
  double gear_efficiency = 1.0;
  double battery_V = 0.0;                                            ///< nominal
  double voltage_limit_V = std::numeric_limits<double>::infinity();  ///< of the driver's command, one motor
  double current_limit_A = std::numeric_limits<double>::infinity();  ///< equivalent DC current, one motor
  Commutation commutation = Commutation::block;
  double mass_kg = 0.0;
  double wheel_contact_radius_m = 0.0;  ///< from the robot's axis to the wheels' contact points
  std::vector<double> wheel_axis_rad;   ///< direction of each wheel's axle from straight ahead, counter-clockwise, wheel 1 first

  // Figures with origin, kAbsent where the file has none: what moving the robot needs, but a prescribed duty does not.
  double yaw_inertia_kg_m2 = kAbsent;  ///< about the vertical through the centre of gravity, wheels included
  double center_of_gravity_height_m = kAbsent;
  double center_of_gravity_x_m = kAbsent;     ///< ahead of the axis; 0 where absent
  double center_of_gravity_y_m = kAbsent;     ///< left of it; 0 where absent
  double wheel_inertia_kg_m2 = kAbsent;       ///< one wheel about its axle, without the motor's rotor
  double wheel_friction_torque_Nm = kAbsent;  ///< at the wheel, without the motor's own drag
  double wheel_damping_Nm_s_per_rad = kAbsent;
  double roller_drag_ratio = kAbsent;      ///< drag along the axle per normal force
  double rolling_efficiency = kAbsent;     ///< of the wheel's torque that reaches the ground; 1 where absent
  double traction_ratio = kAbsent;         ///< largest rolling force per normal force
  double slip_speed_m_per_s = kAbsent;     ///< slip at which 0.71 of it is used
  double driver_resistance_ohm = kAbsent;  ///< switches and traces of one motor, in series with the winding
  double driver_standby_W = kAbsent;       ///< per motor: gate drive, logic, switching
  double control_rate_Hz = kAbsent;        ///< of the firmware's commands to the motors
  double command_rate_Hz = kAbsent;        ///< of the commands that the team's computer sends to the robot
  double battery_full_V = kAbsent;
  double battery_empty_V = kAbsent;
  double battery_resistance_ohm = kAbsent;
  double battery_capacity_A_s = kAbsent;
  double speed_limit_m_per_s = kAbsent;  ///< of the team's planner, as are the others
  double acceleration_limit_m_per_s2 = kAbsent;
  double braking_limit_m_per_s2 = kAbsent;
  double jerk_limit_m_per_s3 = kAbsent;
  double yaw_rate_limit_rad_per_s = kAbsent;
  double yaw_acceleration_limit_rad_per_s2 = kAbsent;
  // A measured curve of friction over the direction of travel; friction.h has its formula.
  double heading_constant_Nm = kAbsent;  ///< of all wheels, absent where each has its own
  double heading_sine_Nm = kAbsent;
  double heading_double_angle_Nm = kAbsent;            ///< 0 where absent
  double heading_rotation_Nm = kAbsent;                ///< wheel_friction_torque where absent
  std::vector<double> heading_double_angle_phase_rad;  ///< per wheel; empty without double angle
  std::vector<HeadingWheel> heading_wheels;            ///< one per wheel, or none
  std::map<std::string, Figure, std::less<>> figures;  ///< by "table.key", "friction.heading.wheel[0].key"
  bool is_friction_assumed = false;                    ///< by with_assumed_friction(): the file states none

  [[nodiscard]] double available_V() const;
  /// Between the battery and a motor's terminals; a robot that does not say has none.
  [[nodiscard]] double series_resistance_ohm() const;
};

/// The one declaration of a robot figure: where the file has it, and where its number goes.
struct RobotFigureSpec {
  std::string_view table;
  ParameterSpec spec;
  double Robot::*value = nullptr;
};
std::span<const RobotFigureSpec> robot_figure_specs();

/// The same for the figures of one [[friction.heading.wheel]].
struct WheelFigureSpec {
  ParameterSpec spec;
  double HeadingWheel::*value = nullptr;
};
std::span<const WheelFigureSpec> wheel_figure_specs();

/// Throws Failure (bad_input) that names every figure of `tables` that the robot lacks, optional ones apart.
void require_figures(const Robot& robot, std::span<const std::string_view> tables);

/// The robot with one draw of every declared tolerance and range.
Robot draw_sample(const Robot& robot, Random& random);

/// Throws Failure (bad_input) with every problem of the file.
Robot read_robot(const std::filesystem::path& path);

/// The same of a file's text; `path` names the robot.
Robot parse_robot(const std::string& text, const std::filesystem::path& path);

}  // namespace heatsoak
