// From positions with noise to velocity and acceleration: what the wheels had to do.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "duty/recorded_game.h"

namespace heatsoak::duty {

/// Everything in the frame of the field; yaw counts counter-clockwise.
struct Motion {
  double time_s = 0.0;
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;
  double velocity_x_m_per_s = 0.0;
  double velocity_y_m_per_s = 0.0;
  double yaw_rate_rad_per_s = 0.0;
  double acceleration_x_m_per_s2 = 0.0;
  double acceleration_y_m_per_s2 = 0.0;
  double yaw_acceleration_rad_per_s2 = 0.0;
};

struct SmoothingOptions {
  /// Where the smoother lets 71 % of an amplitude through (-3 dB), while the robot accelerates. Empty: as wide as the
  /// noise allows, so that it makes up a set share of the squared acceleration.
  std::optional<double> bandwidth_Hz;
};
/// How the place or the turn of a track was smoothed. Its unit is m, or rad.
struct ChannelReport {
  /// As used: never more than a sixth of the frame rate. Of motion beyond some 10 m/s² points are doubted that the smoother cannot follow:
  /// with 13 m/s² at single frequencies the -3 dB of 8 Hz lie at 7.4 Hz.
  double bandwidth_Hz = 0.0;
  double quiet_bandwidth_Hz = 0.0;  ///< used while nothing but noise is seen: standing, or running steadily
  double quiet_share = 0.0;         ///< of the time
  double noise_m_or_rad = 0.0;      ///< rms of one coordinate around the smooth track
  /// rms that this noise leaves in the acceleration of one coordinate at bandwidth_Hz.
  double acceleration_noise_m_or_rad_per_s2 = 0.0;
  double noise_share = 0.0;    ///< of ∫a², as far as it can be foreseen
  std::uint64_t outliers = 0;  ///< points that had no say
};

/// What smoothing means for the answer; said with every import.
struct SmoothingReport {
  double frame_rate_Hz = 0.0;  ///< usual one of the track
  std::uint64_t points = 0;
  ChannelReport place;
  ChannelReport turn;
};
std::string to_string(const SmoothingReport& report);

/// The smoothed motion between its points, by the polynomials of fifth degree that keep position, velocity and acceleration
/// continuous: the smoother's own answer between two sights.
class MotionTrack {
 public:
  using Segment = std::vector<Motion>;

  MotionTrack(RobotName robot, std::vector<Segment> segments, SmoothingReport report)
      : robot_(robot), segments_(std::move(segments)), report_(report) {}

  [[nodiscard]] const RobotName& robot() const { return robot_; }
  [[nodiscard]] const std::vector<Segment>& segments() const { return segments_; }
  [[nodiscard]] const SmoothingReport& report() const { return report_; }
  /// Nothing where the robot is not seen.
  [[nodiscard]] std::optional<Motion> at(double time_s) const;
  /// Every 1/rate_Hz through each segment, from its first point on, without storing them.
  void for_each(double rate_Hz, const std::function<void(const Motion&, std::size_t segment)>& visit) const;

 private:
  RobotName robot_;
  std::vector<Segment> segments_;
  SmoothingReport report_;
};

MotionTrack smooth(const RobotTrack& track, const SmoothingOptions& options = {});

}  // namespace heatsoak::duty
