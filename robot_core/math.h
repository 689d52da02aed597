// The few functions of <cmath> that the drive core needs: a freestanding build has no <cmath>.
#pragma once

#include <limits>

namespace robot_core {

template <typename Real>
constexpr Real absolute(Real x) {
  return x < Real(0) ? -x : x;
}

template <typename Real>
constexpr Real smaller(Real a, Real b) {
  return b < a ? b : a;
}

template <typename Real>
constexpr Real larger(Real a, Real b) {
  return a < b ? b : a;
}

template <typename Real>
constexpr Real clamped(Real x, Real low, Real high) {
  return x < low ? low : (high < x ? high : x);
}

/// False for NaN and both infinities.
template <typename Real>
constexpr bool is_finite(Real x) {
  return absolute(x) <= std::numeric_limits<Real>::max();
}

namespace detail {

// One correctly rounded instruction where the target has it: the core is compiled with -fno-math-errno, without which
// the builtin would also call the C library.
inline double sqrt_instruction(double x) { return __builtin_sqrt(x); }
inline float sqrt_instruction(float x) { return __builtin_sqrtf(x); }

}  // namespace detail

/// Square root; of a negative number (a rounding error of zero, where this is used) it is 0.
template <typename Real>
inline Real square_root(Real x) {
  return x > Real(0) ? detail::sqrt_instruction(x) : Real(0);
}

}  // namespace robot_core
