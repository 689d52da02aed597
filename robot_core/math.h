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

// Every target's square root is one correctly rounded instruction. The builtin alone would also call the C library
// for negative arguments, to set errno, unless the whole program is compiled with -fno-math-errno.
inline double sqrt_instruction(double x) {
#if defined(__NO_MATH_ERRNO__)
  return __builtin_sqrt(x);
#elif defined(__x86_64__)
  double y;  // NOLINT(cppcoreguidelines-init-variables): written by the instruction
  __asm__("sqrtsd %1, %0" : "=x"(y) : "x"(x));
  return y;
#elif defined(__aarch64__)
  double y;  // NOLINT(cppcoreguidelines-init-variables): written by the instruction
  __asm__("fsqrt %d0, %d1" : "=w"(y) : "w"(x));
  return y;
#elif defined(__ARM_FP) && (__ARM_FP & 8)
  double y;  // NOLINT(cppcoreguidelines-init-variables): written by the instruction
  __asm__("vsqrt.f64 %P0, %P1" : "=w"(y) : "w"(x));
  return y;
#else
  return __builtin_sqrt(x);
#endif
}

inline float sqrt_instruction(float x) {
#if defined(__NO_MATH_ERRNO__)
  return __builtin_sqrtf(x);
#elif defined(__x86_64__)
  float y;  // NOLINT(cppcoreguidelines-init-variables): written by the instruction
  __asm__("sqrtss %1, %0" : "=x"(y) : "x"(x));
  return y;
#elif defined(__aarch64__)
  float y;  // NOLINT(cppcoreguidelines-init-variables): written by the instruction
  __asm__("fsqrt %s0, %s1" : "=w"(y) : "w"(x));
  return y;
#elif defined(__ARM_FP) && (__ARM_FP & 4)
  float y;  // NOLINT(cppcoreguidelines-init-variables): written by the instruction
  __asm__("vsqrt.f32 %0, %1" : "=t"(y) : "t"(x));
  return y;
#else
  return __builtin_sqrtf(x);
#endif
}

}  // namespace detail

/// Square root; of a negative number (a rounding error of zero, where this is used) it is 0.
template <typename Real>
inline Real square_root(Real x) {
  return x > Real(0) ? detail::sqrt_instruction(x) : Real(0);
}

}  // namespace robot_core
