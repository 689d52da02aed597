// Where a robot drove steadily, found from the noise of the signals themselves.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "identify/friction/friction_log.h"

namespace heatsoak {

// How. Rows are condensed into medians of five to nine rows, which one or two bad rows of five do not move. Medians in
// which the robot stands part the log into legs, as do changes of direction. Within a leg the cumulative sum of each
// signal about its mean tells whether the mean changes (Page 1954): where the largest sum exceeds what the noise
// explains, 1.95·σ·√n (Brownian bridge, 0.1 %), and the means on both sides differ by more than 0.5 %, the leg is parted
// there and both sides are asked again. What is left undivided over at least five medians is steady; of several such
// stretches at one speed the longest counts, because the others settle towards it. σ comes from second differences, so
// that a slow change does not count as noise. A wheel that should stand does not part a leg.

/// One steady stretch at one heading and speed (or turning on the spot).
struct SteadyPart {
  int leg = 0;             ///< counts over all logs
  bool is_return = false;  ///< the leg brings the robot back to where the leg before began
  bool is_rotation = false;
  std::size_t first_row = 0;  ///< of its log
  std::size_t row_count = 0;
  PerWheel wheel_speed_rad_per_s{};
  PerWheel voltage_V{};
  PerWheel speed_noise_rad_per_s{};  ///< standard deviation of the rows
  std::array<int, kMostWheels> rows_kept{};
  double heading_rad = 0.0;  ///< direction of travel in the robot's frame
  double speed_m_per_s = 0.0;
  double yaw_rad_per_s = 0.0;
};

struct SteadyParts {
  std::vector<SteadyPart> parts;
  std::size_t rows = 0;         ///< of all logs
  std::size_t rows_steady = 0;  ///< in parts
  int legs = 0;
  int return_legs = 0;
};

/// t_i·v/|v|: with it a wheel turns on this heading.
double rolling_share(const WheelDirections& wheel, double heading_rad);
/// By geometry, as the paper has it: |t_i·v| < 0.1·|v|. Such a wheel tells nothing.
bool should_stand(const WheelDirections& wheel, double heading_rad);

/// The parts of several logs in their order.
SteadyParts find_steady_parts(const std::vector<FrictionLog>& logs, const Kinematics& kinematics);

}  // namespace heatsoak
