// Merges periods of the firmware into longer intervals for the motor's network.
#pragma once

#include <cmath>

namespace heatsoak::derate {

/// One interval and its RMS current. It ends if the current changes by more than 2 %, if the speed changes, or after 1 s.
struct HeldCurrent {
  double duration_s = 0.0;
  double heat_A2_s = 0.0;
  double first_A = 0.0;
  double speed_rad_per_s = 0.0;

  /// True if the next period, with current magnitude `current_A`, starts another interval.
  [[nodiscard]] bool is_over(double current_A, double at_rad_per_s) const {
    constexpr double kLongest_s = 1.0;
    constexpr double kLittle_share = 0.02;
    return duration_s > 0.0 &&
           (duration_s >= kLongest_s || std::abs(current_A - first_A) > kLittle_share * first_A || at_rad_per_s != speed_rad_per_s);
  }
  void take(double current_A, double at_rad_per_s, double period_s) {
    speed_rad_per_s = at_rad_per_s;
    first_A = duration_s > 0.0 ? first_A : current_A;
    duration_s += period_s;
    heat_A2_s += current_A * current_A * period_s;
  }
  [[nodiscard]] double rms_A() const { return std::sqrt(heat_A2_s / duration_s); }
};

}  // namespace heatsoak::derate
