// What the friction test needs of a log, as columns.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "robot/kinematics.h"

namespace heatsoak {

/// Rows of one log; columns have one value per row, NaN where nothing was measured, or are empty where the log has none.
struct FrictionLog {
  std::string name;
  std::vector<double> time_s;           ///< strictly increasing
  std::vector<std::size_t> run_begins;  ///< rows before which what happened is unknown; the first one is 0
  std::array<std::vector<double>, kMostWheels> wheel_speed_rad_per_s;
  std::array<std::vector<double>, kMostWheels> voltage_V;  ///< at the driver's output; empty for a roll-out
  std::vector<double> heading_rad;                         ///< direction of travel in the robot's frame; empty: from the wheels
  std::vector<double> yaw_rad;                             ///< empty: from the wheels

  [[nodiscard]] std::size_t rows() const { return time_s.size(); }
};

}  // namespace heatsoak
