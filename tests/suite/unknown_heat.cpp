#include "unknown_heat.h"

#include <array>
#include <cmath>
#include <numbers>

namespace heatsoak::suite {
namespace {

void add_ornstein_uhlenbeck(double size_W, double step_s, Random& random, std::vector<double>& heat_W) {
  const double time_scale_s = random.log_uniform(60.0, 700.0);
  const double kept_share = std::exp(-step_s / time_scale_s);
  double now_W = size_W * random.normal();
  for (double& each_W : heat_W) {
    each_W = now_W;
    now_W = kept_share * now_W + size_W * std::sqrt(1.0 - kept_share * kept_share) * random.normal();
  }
}

void add_steps(double size_W, double step_s, Random& random, std::vector<double>& heat_W) {
  const double mean_s = random.log_uniform(80.0, 500.0);
  double left_s = 0.0;
  double now_W = 0.0;
  for (double& each_W : heat_W) {
    if (left_s <= 0.0) {
      left_s = random.exponential(mean_s);
      now_W = size_W * random.normal();
    }
    left_s -= step_s;
    each_W = now_W;
  }
}

void add_sines(double size_W, double step_s, Random& random, std::vector<double>& heat_W) {
  struct Sine {
    double period_s;
    double phase_rad;
  };
  std::array<Sine, 3> sines{};
  for (Sine& sine : sines) {
    sine = {random.log_uniform(120.0, 1500.0), random.uniform(0.0, 2.0 * std::numbers::pi)};
  }
  for (std::size_t i = 0; i < heat_W.size(); ++i) {
    for (const Sine& sine : sines) {
      heat_W[i] += 0.8 * size_W * std::sin(2.0 * std::numbers::pi * static_cast<double>(i) * step_s / sine.period_s + sine.phase_rad);
    }
  }
}

/// A straight line through the run, from -1.7 to 1.7 sizes or the reverse, and a random walk of a third of it.
void add_drift(double size_W, Random& random, std::vector<double>& heat_W) {
  const double slope_W = random.sign() * 1.7 * size_W;
  const double count = static_cast<double>(heat_W.size());
  double walk_W = 0.0;
  for (std::size_t i = 0; i < heat_W.size(); ++i) {
    heat_W[i] = slope_W * (2.0 * static_cast<double>(i) / count - 1.0) + walk_W;
    walk_W += 0.6 * size_W * random.normal() / std::sqrt(count);
  }
}

}  // namespace

std::string name_of(UnknownHeat kind) {
  switch (kind) {
    case UnknownHeat::kOrnsteinUhlenbeck:
      return "ornstein_uhlenbeck";
    case UnknownHeat::kSteps:
      return "steps";
    case UnknownHeat::kSines:
      return "sines";
    default:
      return "drift";
  }
}

std::vector<double> unknown_heat_W(UnknownHeat kind, double size_W, std::size_t steps, double step_s, Random random) {
  std::vector<double> heat_W(steps, 0.0);
  switch (kind) {
    case UnknownHeat::kOrnsteinUhlenbeck:
      add_ornstein_uhlenbeck(size_W, step_s, random, heat_W);
      break;
    case UnknownHeat::kSteps:
      add_steps(size_W, step_s, random, heat_W);
      break;
    case UnknownHeat::kSines:
      add_sines(size_W, step_s, random, heat_W);
      break;
    case UnknownHeat::kDrift:
      add_drift(size_W, random, heat_W);
      break;
  }
  return heat_W;
}

}  // namespace heatsoak::suite
