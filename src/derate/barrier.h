// Exact allowed current: the largest current at which the control barrier holds. The derating table stays below it.
#pragma once

#include <vector>

#include "derate/hot_cases.h"
#include "derate/observer.h"

namespace heatsoak::derate {

/// Keeps a reference to the rules, which must outlive it. Not thread-safe.
class Barrier {
 public:
  Barrier(const Observer& observer, const BarrierRules& rules);

  /// Returns the square, in A², of the largest current at which the barrier holds in every hot case. The heat must increase with the
  /// current. The result is rounded down and accurate to 1 in 10⁶.
  /// It is negative if the barrier is violated even without current. It is then extrapolated linearly in the square of the current, from
  /// the margins without current and at a small one, so that it has no kink at 0. It is extrapolated too above (2·most_current)², from the
  /// margins without current and at that square, because its accuracy does not matter there. The range is −(2·most_current)² to
  /// (8·most_current)².
  double square_A2(double speed_rad_per_s, double stator_C, double winding_C);
  /// Returns the root of square_A2() in A, limited to the range from 0 to the most current of the rules.
  double current_A(double speed_rad_per_s, double stator_C, double winding_C);

 private:
  struct Place {
    double speed_rad_per_s;
    double stator_C;
    double winding_C;
  };
  /// Margins of the barrier in K/s: the allowed minus the actual heating rate of winding and stator. At least 0 if the barrier holds.
  double winding_margin(const HotCase& each, const Place& at, double current_square_A2);
  double stator_margin(const HotCase& each, const Place& at, double current_square_A2);
  void find_rates(const Signals& signals, double stator_C, double winding_C);

  const BarrierRules& rules_;
  std::vector<HotCase> cases_;
  thermal::FormulaRun<double> rates_;
  std::vector<double> signals_;  ///< inputs of the formula: signals, then node temperatures in °C
  std::vector<double> rate_;
};

/// Barrier::current_A() for a single evaluation; builds the barrier each time.
double barrier_current_A(const Observer& observer, const BarrierRules& rules, double speed_rad_per_s, double stator_C, double winding_C);

}  // namespace heatsoak::derate
