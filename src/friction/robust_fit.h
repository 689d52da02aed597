// Robust estimation of location and robust linear regression.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

namespace heatsoak::friction {

/// Interval in the unit of its value.
struct Interval {
  double low = 0.0;
  double high = 0.0;
};
/// A value with its 95 % interval. The interval is empty if the data do not determine it.
struct Estimate {
  double value = 0.0;
  std::optional<Interval> interval = {};
};
/// Returns the value with the interval value ± spread; without an interval if `spread` is not finite.
Estimate estimate_around(double value, double spread);

/// Median of the finite values; NaN if there are none. Reorders `values`.
double median(std::span<double> values);

/// Location by Tukey's bisquare M-estimate (c = 4.685), started at the median, with the scale from the median absolute deviation.
struct RobustLocation {
  std::optional<double> value = {};  ///< empty if no value is finite
  double noise = 0.0;                ///< robust standard deviation
  std::vector<bool> kept;            ///< per value: finite and not an outlier
};
/// Estimates the location of the finite values. `step` is the resolution of the sensor: deviations up to half of it are no outliers.
RobustLocation robust_location(std::span<const double> values, double step);

/// Robust regression y = X·β, in which up to a fifth of the values may be outliers: least absolute deviations, then Tukey's bisquare. The
/// covariance is a cluster-robust sandwich estimate (clusters are rows that share an error), so that unequal variances do no harm (Croux,
/// Dhaene, Hoorelbeke 2004). Residuals are corrected for leverage. If few clusters determine a coefficient, its variance is uncertain; the
/// degrees of freedom are therefore Satterthwaite's (Bell, McCaffrey 2002; Pustejovsky, Tipton 2018).
struct RobustFit {
  Eigen::VectorXd coefficients;
  Eigen::MatrixXd covariance;
  Eigen::VectorXd weights;         ///< per row, 0 to 1; 0 is an outlier
  Eigen::VectorXd freedom_counts;  ///< degrees of freedom per coefficient

  /// Student's 97.5 % quantile for the coefficient's degrees of freedom.
  [[nodiscard]] double quantile_factor(Eigen::Index coefficient) const;
  [[nodiscard]] Estimate estimate(Eigen::Index coefficient) const;
};
/// Fits β. `cluster` has the cluster number of each row.
RobustFit robust_fit(const Eigen::MatrixXd& X, const Eigen::VectorXd& y, std::span<const int> cluster);

/// Returns the RMS share of a column that is linearly independent of the other columns; 0 means collinear.
double independent_share(const Eigen::MatrixXd& X, Eigen::Index column);

}  // namespace heatsoak::friction
