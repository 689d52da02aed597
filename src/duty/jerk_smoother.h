// Smooths one coordinate with a forward Kalman filter and a backward Rauch-Tung-Striebel smoother. The model's jerk is white noise.
#pragma once

#include <span>
#include <vector>

namespace heatsoak::duty {

/// Smoothed position, velocity and acceleration, in the unit of the coordinate and seconds.
struct Smoothed {
  double value = 0.0;
  double rate = 0.0;
  double acceleration = 0.0;
};

struct Sample {
  double time_s = 0.0;
  double value = 0.0;
  double weight = 1.0;        ///< weight of the sample, 0 to 1
  double bandwidth_Hz = 5.0;  ///< -3 dB bandwidth between this sample and the next
};

/// Returns the smoothed samples. For samples `step_s` apart the amplitude response is 1 / (1 + (f/f0)^6) with zero phase; f0 follows from
/// the bandwidth. The result depends only on the ratio of jerk to noise, not on the noise itself.
std::vector<Smoothed> smooth_samples(std::span<const Sample> samples, double step_s);

/// Returns the RMS acceleration after smoothing that white noise of RMS `value` per sample causes.
double acceleration_noise(double value, double step_s, double bandwidth_Hz);

}  // namespace heatsoak::duty
