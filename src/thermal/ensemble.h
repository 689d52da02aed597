// Simulates many parameter samples over one duty: kLanes of them at once, with a fixed step chosen from the time constants of the network.
// tests/thermal/ensemble_test.cpp compares it with the reference solver.
#pragma once

#include <span>
#include <vector>

#include "thermal/lanes.h"
#include "thermal/network.h"

namespace heatsoak::thermal {

/// Maximum number of steps of one run; more would mean a time constant far too small for the duty.
inline constexpr long kMostSteps = 2'000'000;

/// Returns the longest step with which the classical Runge-Kutta method keeps its error below 1e-5 of the fastest transient. It uses a
/// bound on the eigenvalues of the network at `at`. The last state node is taken at `rise_K` above ambient and each node before it another
/// `rise_K` higher, because convection and radiation are faster at higher temperatures.
double longest_step_s(const Network& network, std::span<const Lanes> parameters, const OperatingPoint<Lanes>& at, double rise_K = 0.0);

/// A running integration of kLanes samples. Temperatures are clamped to kDestroyed_C.
class EnsembleRun {
 public:
  EnsembleRun(const Network& network, std::span<const Lanes> parameters, std::span<const Lanes> start_C);

  /// Integrates over an interval in equal steps no longer than `longest_step_s`. `at` is modified during the call and restored, as in
  /// Network::rate_K_per_s().
  void over(double duration_s, OperatingPoint<Lanes>& at, double longest_step_s);
  void over(double duration_s, const OperatingPoint<Lanes>& at, double longest_step_s) {
    OperatingPoint<Lanes> own = at;
    over(duration_s, own, longest_step_s);
  }
  [[nodiscard]] const std::vector<Lanes>& state_C() const { return state_C_; }
  [[nodiscard]] const std::vector<Lanes>& peak_C() const { return peak_C_; }

 private:
  void one_step(double step_s, OperatingPoint<Lanes>& at);

  const Network& network_;
  std::span<const Lanes> parameters_;
  std::vector<Lanes> state_C_;
  std::vector<Lanes> peak_C_;
  std::vector<Lanes> stage_C_;  ///< node_count() entries; the last is ambient
  std::vector<Lanes> rate_;
  std::vector<Lanes> sum_;
};

}  // namespace heatsoak::thermal
