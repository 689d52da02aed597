// Dual number with up to eight derivative directions (forward-mode differentiation). A law written for `double` also runs on it.
#pragma once

#include <ceres/jet.h>

namespace heatsoak::thermal {

inline constexpr int kDirections = 8;
using Tangent = ceres::Jet<double, kDirections>;

// The functions of scalar.h.
inline Tangent magnitude(const Tangent& x) { return ceres::abs(x); }
inline Tangent positive_part(const Tangent& x) { return x.a > 0.0 ? x : Tangent(0.0); }
inline Tangent soft_positive_part(const Tangent& x, double width) { return 0.5 * (x + ceres::sqrt(x * x + width * width)); }
inline Tangent power(const Tangent& base, const Tangent& exponent) { return base.a > 0.0 ? ceres::pow(base, exponent) : Tangent(0.0); }
inline Tangent exponential(const Tangent& x) { return ceres::exp(x); }
inline Tangent soft_step(const Tangent& x) {
  const Tangent decay = ceres::exp(-ceres::abs(x));
  return (x.a < 0.0 ? decay : Tangent(1.0)) / (1.0 + decay);
}
inline int chosen(const Tangent& parameter) { return static_cast<int>(parameter.a); }

}  // namespace heatsoak::thermal
