#include "thermal/ensemble.h"

#include <algorithm>
#include <cmath>

#include "thermal/transient.h"

namespace heatsoak::thermal {

double longest_step_s(const Network& network, std::span<const Lanes> parameters, const OperatingPoint<Lanes>& at, double rise_K) {
  constexpr double kStepPerTimeConstant = 0.25;
  const auto states = static_cast<std::size_t>(network.state_count());
  OperatingPoint<Lanes> moment = at;
  std::vector<Lanes> state_C(states + 1);
  std::vector<Lanes> rate(states);
  std::vector<Lanes> moved(states);
  for (std::size_t i = 0; i < states; ++i) {
    state_C[i] = at.ambient_C + rise_K * static_cast<double>(states - i);
  }
  network.rate_K_per_s<Lanes>(moment, parameters, state_C, rate);
  // Gershgorin's theorem: no eigenvalue exceeds the largest row sum of absolute entries.
  std::vector<Lanes> row_sum(states, Lanes::Zero());
  for (std::size_t i = 0; i < states; ++i) {
    state_C[i] += 1.0;
    network.rate_K_per_s<Lanes>(moment, parameters, state_C, moved);
    state_C[i] -= 1.0;
    for (std::size_t j = 0; j < states; ++j) {
      row_sum[j] += (moved[j] - rate[j]).abs();
    }
  }
  double fastest_per_s = 1e-9;
  for (const Lanes& sum : row_sum) {
    fastest_per_s = std::max(fastest_per_s, sum.maxCoeff());
  }
  return kStepPerTimeConstant / fastest_per_s;
}

EnsembleRun::EnsembleRun(const Network& network, std::span<const Lanes> parameters, std::span<const Lanes> start_C)
    : network_(network),
      parameters_(parameters),
      state_C_(start_C.begin(), start_C.end()),
      peak_C_(state_C_),
      stage_C_(state_C_.size() + 1),
      rate_(state_C_.size()),
      sum_(state_C_.size()) {}

void EnsembleRun::over(double duration_s, OperatingPoint<Lanes>& at, double longest_step_s) {
  const double steps = std::max(1.0, std::ceil(duration_s / longest_step_s));
  for (int i = 0; i < static_cast<int>(steps); ++i) {
    one_step(duration_s / steps, at);
  }
}

void EnsembleRun::one_step(double step_s, OperatingPoint<Lanes>& at) {
  struct Stage {
    double share;   ///< time of the stage as a share of the step
    double weight;  ///< weight of the stage's rate in the result
  };
  constexpr Stage kClassical[] = {{0.0, 1.0 / 6.0}, {0.5, 1.0 / 3.0}, {0.5, 1.0 / 3.0}, {1.0, 1.0 / 6.0}};
  const std::size_t states = state_C_.size();
  std::fill(sum_.begin(), sum_.end(), Lanes::Zero());
  std::fill(rate_.begin(), rate_.end(), Lanes::Zero());
  for (const auto& [share, weight] : kClassical) {
    for (std::size_t i = 0; i < states; ++i) {
      stage_C_[i] = state_C_[i] + share * step_s * rate_[i];
    }
    network_.rate_K_per_s<Lanes>(at, parameters_, stage_C_, rate_);
    for (std::size_t i = 0; i < states; ++i) {
      sum_[i] += weight * rate_[i];
    }
  }
  for (std::size_t i = 0; i < states; ++i) {
    state_C_[i] = (state_C_[i] + step_s * sum_[i]).min(kDestroyed_C);
    peak_C_[i] = peak_C_[i].max(state_C_[i]);
  }
}

}  // namespace heatsoak::thermal
