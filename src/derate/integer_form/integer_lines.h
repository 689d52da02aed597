// The observer's rates as statements over 32-bit integers, for controllers without a floating-point unit.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "derate/derating.h"

namespace heatsoak::derate::integer_form {

/// Fraction bits of state temperatures: resolution 2^-20 K, range ±1000 °C.
inline constexpr int kStateBits = 20;
/// Inputs are integers in thousandths: mA, mrad/s, 0.001 °C.
inline constexpr double kThousandths_ratio = 1000.0;
/// 1/1000 in 2^-39, which is PREFIX_ONE_THOUSANDTH in the statements.
inline constexpr std::int64_t kOneThousandth = 549755814;

/// A value n·2^-bits with |n| < 2^30.
struct FixedPoint {
  double low = 0.0;  ///< bounds of the value
  double high = 0.0;
  int bits = 0;
  double most_error = 0.0;  ///< bound of the error for all plausible inputs
};

struct IntegerLines {
  /// One line "  const int32_t copper_loss_W = …; /* 2^-23 W */" per quantity that the formula names, with the value of its last bit. Other
  /// steps of the formula stand where they are used. Inputs are input->…, states state_C[node]; names of helpers begin with the prefix
  /// and "_".
  std::string text;
  std::vector<std::string> rates;        ///< per state: expression of its rate
  std::vector<FixedPoint> rate_K_per_s;  ///< per state
};

/// Generates the statements. Interval arithmetic selects the scale of each step and bounds its rounding error. Throws Failure (bad_input)
/// with the failing effects if a law needs a function without an integer implementation, or divides by a value that may be 0.
IntegerLines integer_lines(const Derating& derating, const std::string& prefix);

}  // namespace heatsoak::derate::integer_form
