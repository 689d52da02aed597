// Functions that laws need beyond arithmetic, for double. The headers lanes.h, tangent.h and traced.h have them for the other scalar types.
#pragma once

#include <cmath>
#include <string_view>

namespace heatsoak::thermal {

/// Returns |x|.
inline double magnitude(double x) { return std::abs(x); }

/// Returns max(0, x).
inline double positive_part(double x) { return x > 0.0 ? x : 0.0; }

/// Smooth approximation of max(0, x): (x + √(x² + width²))/2. `width` has the unit of x; the value at 0 is width/2.
inline double soft_positive_part(double x, double width) { return 0.5 * (x + std::sqrt(x * x + width * width)); }

/// Returns base^exponent for base > 0; 0 with zero derivatives for base ≤ 0.
inline double power(double base, double exponent) { return base > 0.0 ? std::pow(base, exponent) : 0.0; }

inline double exponential(double x) { return std::exp(x); }

/// Logistic function 1/(1 + e^(−x)), a differentiable step. This form neither overflows nor loses digits in the tails.
inline double soft_step(double x) {
  const double decay = std::exp(-std::abs(x));
  return (x < 0.0 ? decay : 1.0) / (1.0 + decay);
}

/// Returns `x`, an intermediate quantity of a law. Generated code has a line of its own for it, under `name`, which ends in the
/// unit: "air_gap_conductance_W_per_K". Only Traced records the name; for every other type the call has no cost. A law names each step that
/// it uses more than once, and each operand of magnitude() and positive_part().
template <class S>
constexpr const S& named(std::string_view /*name*/, const S& x) {
  return x;
}

/// Returns the difference of two temperatures in K; its name in generated code is "winding_above_stator_K". Of Lanes the result refers to
/// the arguments.
template <class S>
auto difference_K(const S& hot_C, const S& cold_C) {
  return hot_C - cold_C;
}

/// Returns the index that a choice parameter holds.
inline int chosen(double parameter) { return static_cast<int>(parameter); }

}  // namespace heatsoak::thermal
