#include "duty/jerk_smoother.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace heatsoak::duty {
namespace {

constexpr double kDecibel3 = 0.8634;  // (√2 - 1)^(1/6): 1 / (1 + u^6) = 1/√2
constexpr double kLeastWeight = 1e-9;
// Prior standard deviations before the first sample, as multiples of the sample noise per s and s²: practically uninformative.
constexpr double kUnknownRate = 1e4;
constexpr double kUnknownAcceleration = 1e5;

double corner_rad_per_s(double bandwidth_Hz) { return 2.0 * std::numbers::pi * bandwidth_Hz / kDecibel3; }

struct State {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
};

Eigen::Matrix3d transition(double step_s) {
  Eigen::Matrix3d f;
  f << 1.0, step_s, 0.5 * step_s * step_s, 0.0, 1.0, step_s, 0.0, 0.0, 1.0;
  return f;
}

/// Returns the process noise covariance of a step for white jerk of unit density.
Eigen::Matrix3d jerk_spread(double t) {
  const double t2 = t * t;
  const double t3 = t2 * t;
  Eigen::Matrix3d q;
  q << t3 * t2 / 20.0, t2 * t2 / 8.0, t3 / 6.0, t2 * t2 / 8.0, t3 / 3.0, t2 / 2.0, t3 / 6.0, t2 / 2.0, t;
  return q;
}

State predicted(const State& from, const Sample& sample, double step_s, double noise_density_s) {
  const double corner = corner_rad_per_s(sample.bandwidth_Hz);
  const Eigen::Matrix3d f = transition(step_s);
  return {f * from.mean, f * from.spread * f.transpose() + noise_density_s * std::pow(corner, 6.0) * jerk_spread(step_s)};
}

/// Updates the state with a sample, whose noise variance is 1/weight.
State updated(const State& from, const Sample& sample) {
  if (sample.weight < kLeastWeight) {
    return from;
  }
  const double total = from.spread(0, 0) + 1.0 / sample.weight;
  const Eigen::Vector3d gain = from.spread.col(0) / total;
  State to;
  to.mean = from.mean + gain * (sample.value - from.mean(0));
  to.spread = from.spread - gain * from.spread.row(0);
  to.spread = 0.5 * (to.spread + to.spread.transpose()).eval();
  return to;
}

}  // namespace

std::vector<Smoothed> smooth_samples(std::span<const Sample> samples, double step_s) {
  const std::size_t count = samples.size();
  std::vector<Smoothed> smoothed(count);
  if (count == 0) {
    return smoothed;
  }
  std::vector<State> before(count);
  std::vector<State> after(count);
  before[0].mean << samples[0].value, 0.0, 0.0;
  before[0].spread.diagonal() << 1e6, kUnknownRate * kUnknownRate, kUnknownAcceleration * kUnknownAcceleration;
  after[0] = updated(before[0], samples[0]);
  for (std::size_t i = 1; i < count; ++i) {
    before[i] = predicted(after[i - 1], samples[i - 1], samples[i].time_s - samples[i - 1].time_s, step_s);
    after[i] = updated(before[i], samples[i]);
  }
  Eigen::Vector3d mean = after[count - 1].mean;
  smoothed[count - 1] = {mean(0), mean(1), mean(2)};
  for (std::size_t i = count - 1; i-- > 0;) {
    const Eigen::Matrix3d f = transition(samples[i + 1].time_s - samples[i].time_s);
    const Eigen::Matrix3d gain = after[i].spread * f.transpose() * before[i + 1].spread.inverse();
    mean = after[i].mean + gain * (mean - before[i + 1].mean);
    smoothed[i] = {mean(0), mean(1), mean(2)};
  }
  return smoothed;
}

double acceleration_noise(double value, double step_s, double bandwidth_Hz) {
  // The integral ∫ω⁴/(1+(ω/ω0)⁶)² dω/2π over all ω is ω0⁵/18.
  return value * std::sqrt(step_s * std::pow(corner_rad_per_s(bandwidth_Hz), 5.0) / 18.0);
}

}  // namespace heatsoak::duty
