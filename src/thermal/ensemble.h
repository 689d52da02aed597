// Many parameter samples over one duty at once: kLanes of them side by side, a fixed step that the network's
// own speed decides. Checked against the reference in tests/thermal/ensemble_test.cpp.
#pragma once

#include <span>
#include <vector>

#include "thermal/network.h"

namespace heatsoak {

/// More steps than this for one run are refused: the network is far too fast for the duty.
inline constexpr long kMostSteps = 2'000'000;

/// The longest step with which the classical Runge-Kutta method stays below 1e-5 of the fastest
/// transient, from a bound on the network's eigenvalues at `at`, with the last state node `rise_K` above ambient and each
/// node before it as much above the next: convection and radiation are faster the hotter it is.
double longest_step_s(const Network& network, std::span<const Lanes> parameters, const OperatingPoint<Lanes>& at, double rise_K = 0.0);

/// A running integration of kLanes samples. Temperatures stop at kDestroyed_C.
class EnsembleRun {
 public:
  EnsembleRun(const Network& network, std::span<const Lanes> parameters, std::span<const Lanes> start_C);

  /// Goes on over an interval, in equal steps no longer than `longest_step_s`.
  void over(double duration_s, const OperatingPoint<Lanes>& at, double longest_step_s);
  [[nodiscard]] const std::vector<Lanes>& state_C() const { return state_C_; }
  [[nodiscard]] const std::vector<Lanes>& peak_C() const { return peak_C_; }

 private:
  void one_step(double step_s);

  const Network& network_;
  std::span<const Lanes> parameters_;
  OperatingPoint<Lanes> at_;
  std::vector<Lanes> state_C_;
  std::vector<Lanes> peak_C_;
  std::vector<Lanes> stage_C_;  ///< node_count() entries; the last is ambient
  std::vector<Lanes> rate_;
  std::vector<Lanes> sum_;
};

}  // namespace heatsoak
