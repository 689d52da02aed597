// Several parameter samples evaluated together (SIMD). A law written for `double` also runs on Lanes.
#pragma once

#include <Eigen/Core>

#include "base/lanes.h"
#include "thermal/scalar.h"

namespace heatsoak::thermal {

using Lanes = Eigen::Array<double, base::kLanes, 1>;
/// Lanes in the precision of the controller.
using SingleLanes = Eigen::Array<float, base::kLanes, 1>;

// The functions of scalar.h.
inline Lanes magnitude(const Lanes& x) { return x.abs(); }
inline Lanes positive_part(const Lanes& x) { return x.max(0.0); }
inline Lanes soft_positive_part(const Lanes& x, double width) { return 0.5 * (x + (x * x + width * width).sqrt()); }
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
/// Returns the index of a parameter that is a choice, which all samples share.
inline int chosen(const Lanes& parameter) { return static_cast<int>(parameter[0]); }

}  // namespace heatsoak::thermal
