// Computes velocity and acceleration from noisy positions.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "duty/recorded_game.h"

namespace heatsoak::duty {

/// Motion in the field frame; yaw is positive counter-clockwise.
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
  /// Bandwidth (-3 dB) of the smoother while the robot accelerates. If it is empty, it is chosen such that noise contributes a fixed share
  /// of the squared acceleration.
  std::optional<double> bandwidth_Hz;
};
/// Smoothing of the position (unit m) or of the yaw (unit rad) of a track.
struct ChannelReport {
  /// Nominal -3 dB bandwidth, at most a sixth of the frame rate. Above about 10 m/s² some points are down-weighted, which lowers it: 7.4
  /// instead of 8 Hz for sines of 13 m/s².
  double bandwidth_Hz = 0.0;
  double quiet_bandwidth_Hz = 0.0;  ///< bandwidth while the acceleration does not exceed the noise: at standstill or constant velocity
  double quiet_share = 0.0;         ///< share of the time with quiet_bandwidth_Hz
  double noise_m_or_rad = 0.0;      ///< RMS noise of one coordinate around the smoothed track
  /// RMS acceleration of one coordinate that this noise causes at bandwidth_Hz.
  double acceleration_noise_m_or_rad_per_s2 = 0.0;
  double noise_share = 0.0;  ///< expected share of the noise in ∫a²
  /// With so much noise the acceleration describes the camera rather than the robot.
  [[nodiscard]] bool is_mostly_noise() const { return noise_share >= 0.5; }
  std::uint64_t outliers = 0;  ///< number of points with weight 0
};

/// Smoothing of a track; printed with every import.
struct SmoothingReport {
  double frame_rate_Hz = 0.0;  ///< usual frame rate of the track
  std::uint64_t points = 0;
  ChannelReport place;
  ChannelReport turn;
};

/// Smoothed motion of a robot. Between points it is a polynomial of fifth degree with continuous position, velocity and acceleration, which
/// is the smoother's estimate between two samples.
class MotionTrack {
 public:
  using Segment = std::vector<Motion>;

  MotionTrack(RobotName robot, std::vector<Segment> segments, SmoothingReport report)
      : robot_(robot), segments_(std::move(segments)), report_(report) {}

  [[nodiscard]] const RobotName& robot() const { return robot_; }
  [[nodiscard]] const std::vector<Segment>& segments() const { return segments_; }
  [[nodiscard]] const SmoothingReport& report() const { return report_; }
  /// Returns the motion at a time; nothing if the robot is not seen.
  [[nodiscard]] std::optional<Motion> at(double time_s) const;
  /// Visits the motion every 1/rate_Hz in each segment, from its first point on. The values are not stored.
  void for_each(double rate_Hz, const std::function<void(const Motion&, std::size_t segment)>& visit) const;

 private:
  RobotName robot_;
  std::vector<Segment> segments_;
  SmoothingReport report_;
};

MotionTrack smooth(const RobotTrack& track, const SmoothingOptions& options = {});

}  // namespace heatsoak::duty
