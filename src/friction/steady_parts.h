// Finds the segments in which a robot drove steadily, based on the noise of the signals themselves.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "friction/friction_log.h"

namespace heatsoak::friction {

// Method. Rows are condensed into medians of five to nine rows, which are insensitive to one or two bad rows. Standstill and changes of
// direction divide the log into legs. Within a leg, the cumulative sum of each signal about its mean detects changes of the mean (Page
// 1954). The leg is divided at its largest value on two conditions: it exceeds the effect of noise, 1.95·σ·√n (Brownian bridge, 0.1 %), and
// the means on both sides differ by more than 0.5 %. Both sides are then tested again. Undivided segments of at least five medians are steady. Of
// several such segments at one speed, only the longest counts, because the others settle towards it. σ is estimated from second
// differences, so that a slow change does not count as noise. A wheel that should stand does not divide a leg.

/// Steady segment with one heading and speed, or with rotation on the spot.
struct SteadyPart {
  int leg = 0;             ///< number of the leg, counted over all logs
  bool is_return = false;  ///< the leg returns to where the leg before began
  bool is_rotation = false;
  std::size_t first_row = 0;  ///< in its log
  std::size_t row_count = 0;
  robot::PerWheel wheel_speed_rad_per_s{};
  robot::PerWheel voltage_V{};
  robot::PerWheel speed_noise_rad_per_s{};  ///< standard deviation of single rows
  std::array<int, robot::kMostWheels> rows_kept{};
  double heading_rad = 0.0;  ///< direction of travel in the robot's frame
  double speed_m_per_s = 0.0;
  double yaw_rad_per_s = 0.0;
};

struct SteadyParts {
  std::vector<SteadyPart> parts;
  std::size_t rows = 0;         ///< number of rows in all logs
  std::size_t rows_steady = 0;  ///< number of rows in `parts`
  int legs = 0;
  int return_legs = 0;
};

/// Returns t_i·v/|v|, the component of the direction of travel along the wheel's rolling direction, −1 to 1.
double rolling_share(const robot::WheelDirections& wheel, double heading_rad);
/// Returns true if the wheel should stand on this heading by geometry: |t_i·v| < 0.1·|v|, as in the paper. It then carries no information.
bool should_stand(const robot::WheelDirections& wheel, double heading_rad);

/// Finds the steady parts of several logs, in order.
SteadyParts find_steady_parts(const std::vector<FrictionLog>& logs, const robot::Kinematics& kinematics);

}  // namespace heatsoak::friction
