// Heat inputs of neighbouring intervals as one, with the same heat.
#pragma once

#include "identify/measured_run.h"

namespace heatsoak {

/// Squares are averaged for currents and the rms speed. What is not known of one interval is independent of what is not known of another.
class MeanInputs {
 public:
  void add(const OperatingPoint<double>& at, double duration_s);
  /// Over `duration_s` of what was added the inputs may have been `other` in place of `at`, or as far on the other side.
  void doubt(const OperatingPoint<double>& at, const OperatingPoint<double>& other, double duration_s);
  [[nodiscard]] double duration_s() const { return duration_s_; }
  /// The next interval of a run; begins anew.
  void take(MeasuredRun& run);

 private:
  static OperatingPoint<double> zero();

  double duration_s_ = 0.0;
  OperatingPoint<double> sum_ = zero();
  OperatingPoint<double> doubt_squared_ = zero();
  bool has_doubt_ = false;
};

}  // namespace heatsoak
