// One coordinate: a Kalman filter forward and a Rauch-Tung-Striebel smoother backward over a model whose jerk is white noise.
#pragma once

#include <span>
#include <vector>

namespace heatsoak::duty {

/// Position, velocity, acceleration; in the unit of the coordinate and seconds.
struct Smoothed {
  double value = 0.0;
  double rate = 0.0;
  double acceleration = 0.0;
};

struct Sample {
  double time_s = 0.0;
  double value = 0.0;
  double weight = 1.0;        ///< 0 … 1: how much of a say it has
  double bandwidth_Hz = 5.0;  ///< -3 dB, between this sample and the next
};

/// The amplitude response of this smoother on samples `step_s` apart is 1 / (1 + (f/f0)^6), without phase; f0 follows from the
/// bandwidth. Only the ratio of jerk to noise counts, so the answer does not depend on how large the noise is.
std::vector<Smoothed> smooth_samples(std::span<const Sample> samples, double step_s);

/// rms of the acceleration that white noise of the rms `value` in each sample leaves behind.
double acceleration_noise(double value, double step_s, double bandwidth_Hz);

}  // namespace heatsoak::duty
