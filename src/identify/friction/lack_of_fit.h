// Whether what the law of friction leaves follows the direction of travel, and what that does to the intervals.
#pragma once

#include <span>

#include "identify/friction/wheel_terms.h"

namespace heatsoak {

// How. What is left is averaged per leg, and on one heading legs differ by what does not repeat; where headings are driven once
// each, the speeds of a leg, or else two headings beside each other take their place. Means over a heading that lie further from 0
// than that explains (F test, 0.1 %) are the law's own error. A smooth error hides partly in a and b: it is taken as of the second and
// third harmonic of the heading, the lowest that the law does not have, of any phase, and as large as what is seen of it.

/// `heading`: per point its number, −1 for rotation. Points of no weight do not count.
LackOfFit lack_of_fit(const std::vector<WheelPoint>& points, std::span<const int> heading, const WheelRegression& asked,
                      const std::vector<WheelTerm>& terms, const RobustFit& fit);

/// Adds to the covariance what an error of `left_V` that follows the heading may have moved.
void widen(const std::vector<WheelPoint>& points, const Eigen::MatrixXd& X, double left_V, RobustFit& fit);

}  // namespace heatsoak
