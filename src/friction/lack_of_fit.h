// Tests whether the residuals of the friction fit depend on the direction of travel, and widens the intervals accordingly.
#pragma once

#include <optional>
#include <span>

#include "friction/wheel_terms.h"

namespace heatsoak::friction {

// Method. Residuals are averaged per leg; the differences between legs on one heading are the scatter of repeats. If each heading was
// driven only once, the speeds of one leg or two neighbouring headings serve as repeats instead. If the means over headings deviate from
// 0 by more than this scatter explains (F test, 0.1 %), the friction law has an error. Part of a smooth error is absorbed by a and b. To
// estimate that part, the error is modelled as second and third harmonic of the heading (the lowest that the law lacks) with any phase,
// scaled to the visible residuals.

/// Tests the residuals of `fit`. `heading` has the heading number of each point; empty for rotation. Points with weight 0 do not count.
LackOfFit lack_of_fit(const std::vector<WheelPoint>& points, std::span<const std::optional<int>> heading, const WheelRegression& asked,
                      const std::vector<WheelTerm>& terms, const RobustFit& fit);

/// Adds to the covariance of `fit` the effect of a heading-dependent error with RMS value `left_V`. No effect if `left_V` is 0.
void widen(const std::vector<WheelPoint>& points, const Eigen::MatrixXd& X, double left_V, RobustFit& fit);

}  // namespace heatsoak::friction
