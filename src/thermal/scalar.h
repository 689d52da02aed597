// The few functions that laws need beyond arithmetic, for every scalar that a law runs on.
#pragma once

#include <cmath>

#include "base/lanes.h"
#include "thermal/tangent.h"

namespace heatsoak {

/// |x|
inline double magnitude(double x) { return std::abs(x); }
inline Lanes magnitude(const Lanes& x) { return x.abs(); }
inline Tangent magnitude(const Tangent& x) { return ceres::abs(x); }

/// max(0, x)
inline double positive_part(double x) { return x > 0.0 ? x : 0.0; }
inline Lanes positive_part(const Lanes& x) { return x.max(0.0); }
inline Tangent positive_part(const Tangent& x) { return x.a > 0.0 ? x : Tangent(0.0); }

/// A positive part without a kink: (x + √(x² + width²))/2, half the width at 0; in the unit of x.
inline double soft_positive_part(double x, double width) { return 0.5 * (x + std::sqrt(x * x + width * width)); }
inline Lanes soft_positive_part(const Lanes& x, double width) { return 0.5 * (x + (x * x + width * width).sqrt()); }
inline Tangent soft_positive_part(const Tangent& x, double width) { return 0.5 * (x + ceres::sqrt(x * x + width * width)); }

/// base^exponent for base > 0, and 0 with all its derivatives for base ≤ 0.
inline double power(double base, double exponent) { return base > 0.0 ? std::pow(base, exponent) : 0.0; }
inline Tangent power(const Tangent& base, const Tangent& exponent) { return base.a > 0.0 ? ceres::pow(base, exponent) : Tangent(0.0); }

inline double exponential(double x) { return std::exp(x); }
inline Tangent exponential(const Tangent& x) { return ceres::exp(x); }

/// 1/(1 + e^(−x)): a step that has derivatives. Written so that no e^… grows and both tails keep their digits.
inline double soft_step(double x) {
  const double decay = std::exp(-std::abs(x));
  return (x < 0.0 ? decay : 1.0) / (1.0 + decay);
}
inline Tangent soft_step(const Tangent& x) {
  const Tangent decay = ceres::exp(-ceres::abs(x));
  return (x.a < 0.0 ? decay : Tangent(1.0)) / (1.0 + decay);
}

// Lane by lane, so that a sample in a lane and one alone have the same bits: Eigen's own differ in the last.
inline Lanes power(const Lanes& base, const Lanes& exponent) {
  return base.binaryExpr(exponent, [](double b, double e) { return power(b, e); });
}
inline Lanes exponential(const Lanes& x) {
  return x.unaryExpr([](double each) { return exponential(each); });
}
inline Lanes soft_step(const Lanes& x) {
  return x.unaryExpr([](double each) { return soft_step(each); });
}

/// A parameter that is a choice, as the place of what was chosen; the same for all samples.
inline int chosen(double parameter) { return static_cast<int>(parameter); }
inline int chosen(const Lanes& parameter) { return static_cast<int>(parameter[0]); }
inline int chosen(const Tangent& parameter) { return static_cast<int>(parameter.a); }

}  // namespace heatsoak
