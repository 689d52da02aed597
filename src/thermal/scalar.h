// Functions that laws need beyond arithmetic, for every scalar type of the laws.
#pragma once

#include <cmath>

#include "base/lanes.h"
#include "thermal/tangent.h"

namespace heatsoak {

/// Returns |x|.
inline double magnitude(double x) { return std::abs(x); }
inline Lanes magnitude(const Lanes& x) { return x.abs(); }
inline Tangent magnitude(const Tangent& x) { return ceres::abs(x); }

/// Returns max(0, x).
inline double positive_part(double x) { return x > 0.0 ? x : 0.0; }
inline Lanes positive_part(const Lanes& x) { return x.max(0.0); }
inline Tangent positive_part(const Tangent& x) { return x.a > 0.0 ? x : Tangent(0.0); }

/// Smooth approximation of max(0, x): (x + √(x² + width²))/2. `width` has the unit of x; the value at 0 is width/2.
inline double soft_positive_part(double x, double width) { return 0.5 * (x + std::sqrt(x * x + width * width)); }
inline Lanes soft_positive_part(const Lanes& x, double width) { return 0.5 * (x + (x * x + width * width).sqrt()); }
inline Tangent soft_positive_part(const Tangent& x, double width) { return 0.5 * (x + ceres::sqrt(x * x + width * width)); }

/// Returns base^exponent for base > 0; 0 with zero derivatives for base ≤ 0.
inline double power(double base, double exponent) { return base > 0.0 ? std::pow(base, exponent) : 0.0; }
inline Tangent power(const Tangent& base, const Tangent& exponent) { return base.a > 0.0 ? ceres::pow(base, exponent) : Tangent(0.0); }

inline double exponential(double x) { return std::exp(x); }
inline Tangent exponential(const Tangent& x) { return ceres::exp(x); }

/// Logistic function 1/(1 + e^(−x)), a differentiable step. This form neither overflows nor loses digits in the tails.
inline double soft_step(double x) {
  const double decay = std::exp(-std::abs(x));
  return (x < 0.0 ? decay : 1.0) / (1.0 + decay);
}
inline Tangent soft_step(const Tangent& x) {
  const Tangent decay = ceres::exp(-ceres::abs(x));
  return (x.a < 0.0 ? decay : Tangent(1.0)) / (1.0 + decay);
}

// Evaluated lane by lane, because Eigen's vector functions differ from the scalar ones in the last bit.
inline Lanes power(const Lanes& base, const Lanes& exponent) {
  return base.binaryExpr(exponent, [](double b, double e) { return power(b, e); });
}
inline Lanes exponential(const Lanes& x) {
  return x.unaryExpr([](double each) { return exponential(each); });
}
inline Lanes soft_step(const Lanes& x) {
  return x.unaryExpr([](double each) { return soft_step(each); });
}

/// Returns the index that a choice parameter holds; it is the same in all samples.
inline int chosen(double parameter) { return static_cast<int>(parameter); }
inline int chosen(const Lanes& parameter) { return static_cast<int>(parameter[0]); }
inline int chosen(const Tangent& parameter) { return static_cast<int>(parameter.a); }

}  // namespace heatsoak
