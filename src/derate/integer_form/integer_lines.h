// The observer's rates as statements over 32-bit integers, for controllers without a floating-point unit.
#pragma once

#include <string>
#include <vector>

#include "derate/derating.h"

namespace heatsoak::integer_form {

/// Temperatures of the states: 2^-20 K a step, up to ±1000 °C.
inline constexpr int kStateBits = 20;
/// An input counts thousandths: mA, mrad/s, 0.001 °C.
inline constexpr double kThousandths_ratio = 1000.0;

/// A value n·2^-bits with |n| < 2^30, and (absolute) how far it may be from the exact one for all inputs that are believed.
struct FixedPoint {
  double low = 0.0;
  double high = 0.0;
  int bits = 0;
  double absolute = 0.0;
};

struct IntegerLines {
  /// "  const int32_t t7 = …;" a line per step. Inputs are input->…, states state_C[node]; helpers have the prefix and "_".
  std::string text;
  std::vector<std::string> rates;        ///< per state: what holds its rate
  std::vector<FixedPoint> rate_K_per_s;  ///< per state
};

/// Interval arithmetic gives every step its scale, and bounds its rounding. Throws Failure (bad_input) with the effects if a law needs a
/// function that integers do not have here, or divides by what may be 0.
IntegerLines integer_lines(const Derating& derating, const std::string& prefix);

}  // namespace heatsoak::integer_form
