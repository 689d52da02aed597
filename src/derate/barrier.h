// The exact answer that the derating table stays below: the largest current at which the control barrier holds.
#pragma once

#include <vector>

#include "derate/hot_cases.h"
#include "derate/observer.h"

namespace heatsoak {

/// Keeps references to the observer and the rules. Not for two threads at once.
class Barrier {
 public:
  Barrier(const Observer& observer, const BarrierRules& rules);

  /// Square of the current in A² up to which the barrier holds in every hot case, for laws that heat more with more current. Negative where
  /// it does not even without current: there the straight line through two currents is continued, so that the answer has no corner at 0.
  /// Between ±(2·most_current)²; accurate to 1 in 10⁶, from below.
  double square_A2(double speed_rad_per_s, double stator_C, double winding_C);
  /// Its root, from 0 to the rules' most current.
  double current_A(double speed_rad_per_s, double stator_C, double winding_C);

 private:
  struct Place {
    double speed_rad_per_s;
    double stator_C;
    double winding_C;
  };
  /// In K/s: what the winding may still heat more; with a stator limit also what the stator may.
  double winding_margin(const HotCase& each, const Place& at, double current_square_A2);
  double stator_margin(const HotCase& each, const Place& at, double current_square_A2);
  void find_rates(const Signals& signals, double stator_C, double winding_C);

  const BarrierRules& rules_;
  std::vector<HotCase> cases_;
  FormulaRun<double> rates_;
  std::vector<double> signals_;  ///< and temperatures, as the formula takes them
  std::vector<double> rate_;
};

/// Barrier::current_A() at one place.
double barrier_current_A(const Observer& observer, const BarrierRules& rules, double speed_rad_per_s, double stator_C, double winding_C);

}  // namespace heatsoak
