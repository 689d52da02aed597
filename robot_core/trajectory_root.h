// Root finding for the monotonic functions of the trajectory planner.
#pragma once

#include <cstdint>
#include <limits>

#include "robot_core/math.h"

namespace robot_core::detail {

/// Value, its first two derivatives, and the magnitude of the terms that make up the value.
template <typename Real>
struct Jet {
  Real value;
  Real magnitude;
  Real first;
  Real second;
};

/// Finds the root of a function that is not above zero at `low` and not below zero at `high`, by Halley's method inside the bracket.
/// `resolution` is the smallest step worth taking at zero.
template <typename Real, typename Function>
inline Real root_between(const Function& function, Real low, Real high, Real guess, Real resolution) {
  constexpr int kMostSteps = 64;
  constexpr Real kEpsilon = std::numeric_limits<Real>::epsilon();
  Real x = clamped(guess, low, high);
  for (int step = 0; step < kMostSteps; ++step) {
    const Jet<Real> f = function(x);
    // Below its own rounding error the sign of a value means nothing.
    if (!(absolute(f.value) > kEpsilon * f.magnitude)) {
      return x;
    }
    (f.value < Real(0) ? low : high) = x;
    Real next = x - Real(2) * f.value * f.first / (Real(2) * f.first * f.first - f.value * f.second);
    if (!(next > low && next < high)) {
      next = x - f.value / f.first;
      if (!(next > low && next < high)) {
        next = low + (high - low) / Real(2);
      }
    }
    if (absolute(next - x) <= Real(2) * kEpsilon * (absolute(x) + resolution)) {
      return next;
    }
    x = next;
  }
  return x;
}

/// Cube root within 6 %, as a first guess: a third of the exponent's bits (and of the others, which come close).
inline double rough_cube_root(double x) {
  return __builtin_bit_cast(double, __builtin_bit_cast(std::uint64_t, x) / 3 + 0x2a9f789300000000U);
}
inline float rough_cube_root(float x) { return __builtin_bit_cast(float, __builtin_bit_cast(std::uint32_t, x) / 3 + 0x2a508c00U); }

}  // namespace robot_core::detail
