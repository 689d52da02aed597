// Columns of a log that the friction test needs.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "robot/kinematics.h"

namespace heatsoak::friction {

/// Rows of one log. A column has one value per row, NaN if not measured; it is empty if the log does not have it.
struct FrictionLog {
  std::string name;
  std::vector<double> time_s;           ///< strictly increasing
  std::vector<std::size_t> run_begins;  ///< first row of each continuous run; the first entry is 0
  /// Speed of each wheel. Only a test with lifted wheels may lack one, which is then empty.
  std::array<std::vector<double>, robot::kMostWheels> wheel_speed_rad_per_s;
  std::array<std::vector<double>, robot::kMostWheels> voltage_V;  ///< at the driver's output; empty for a roll-out
  std::vector<double> heading_rad;  ///< direction of travel in the robot's frame; empty: computed from the wheels
  std::vector<double> yaw_rad;      ///< orientation of the robot; empty: computed from the wheels

  [[nodiscard]] std::size_t rows() const { return time_s.size(); }
};

}  // namespace heatsoak::friction
