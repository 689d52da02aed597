// A robot as its file declares it: what carries the motor, feeds it and limits it.
#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "input/reader.h"

namespace heatsoak {

/// How the driver feeds the three phases. For equal torque a sinusoidal current heats 0.912 as much as block
/// commutation: 0.75·R·Î² against R·I², with K_t per peak ampere 0.907 of the one per DC ampere.
enum class Commutation { block, sinusoidal };

struct Robot {
  std::string id;  ///< the file's stem
  std::filesystem::path file;
  std::string name;
  std::string drive_motor;  ///< id of the motor it is built with
  std::string source;
  double wheel_radius_m = 0.0;
  double gear_ratio = 1.0;      ///< motor turns per wheel turn
  double gear_efficiency = 1.0;
  double battery_V = 0.0;  ///< nominal
  double voltage_limit_V = std::numeric_limits<double>::infinity();  ///< of the driver's command, one motor
  double current_limit_A = std::numeric_limits<double>::infinity();  ///< equivalent DC current, one motor
  Commutation commutation = Commutation::block;
  double mass_kg = 0.0;
  double wheel_contact_radius_m = 0.0;  ///< from the robot's axis to the wheels' contact points
  std::vector<double> wheel_axis_rad;  ///< direction of each wheel's axle from straight ahead, counter-clockwise, wheel 1 first

  [[nodiscard]] double available_V() const;
};

/// Throws Failure (bad_input) with every problem of the file.
Robot read_robot(const std::filesystem::path& path);

}  // namespace heatsoak
