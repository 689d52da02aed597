// Heat inputs of neighbouring intervals as one, with the same heat.
#pragma once

#include "identify/measured_run.h"

namespace heatsoak {

/// Squares are averaged for currents and the rms speed.
class Mean {
 public:
  void add(const OperatingPoint<double>& at, double duration_s);
  [[nodiscard]] double duration_s() const { return duration_s_; }
  /// And begins anew.
  [[nodiscard]] OperatingPoint<double> take();

 private:
  static OperatingPoint<double> zero();

  double duration_s_ = 0.0;
  OperatingPoint<double> sum_ = zero();
};

/// The mean of the inputs, and of what they may be as well.
class MeanInputs {
 public:
  void add(const OperatingPoint<double>& at, double duration_s);
  void add_unknown(const OperatingPoint<double>& at, const OperatingPoint<double>& other, double duration_s);
  [[nodiscard]] double duration_s() const { return mean_.duration_s(); }
  /// The next interval of a run; begins anew.
  void take(MeasuredRun& run);

 private:
  Mean mean_, other_;
  bool has_doubt_ = false;
};

}  // namespace heatsoak
