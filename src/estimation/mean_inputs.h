// Merges the heat inputs of neighbouring intervals into one interval with the same heat.
#pragma once

#include "estimation/measured_run.h"

namespace heatsoak::estimation {

/// Time averages of operating points; current and RMS speed are averaged as squares. An optional quantity is known if it is known in all of
/// them. Uncertainties of different intervals are independent.
class MeanInputs {
 public:
  /// Adds inputs that were held for `duration_s`.
  void add(const thermal::OperatingPoint<double>& at, double duration_s);
  /// Adds uncertainty: for `duration_s` of the added time the inputs may have been `other` instead of `at`, or equally far in the other
  /// direction.
  void add_uncertainty(const thermal::OperatingPoint<double>& at, const thermal::OperatingPoint<double>& other, double duration_s);
  [[nodiscard]] double duration_s() const { return duration_s_; }
  /// Appends the mean and its uncertainty to the run as the next interval, then resets.
  void take(MeasuredRun& run);

 private:
  static thermal::OperatingPoint<double> zero();

  double duration_s_ = 0.0;
  thermal::OperatingPoint<double> sum_ = zero();
  thermal::OperatingPoint<double> variance_ = zero();
  bool has_uncertainty_ = false;
};

}  // namespace heatsoak::estimation
