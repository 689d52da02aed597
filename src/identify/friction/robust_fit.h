// Location and linear regression that bad values do not move.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace heatsoak {

/// A value with its 95 % interval; NaN throughout where the data cannot tell.
struct Estimate {
  double value = std::numeric_limits<double>::quiet_NaN();
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
  [[nodiscard]] bool is_known() const;
};

/// Of the finite ones; NaN of none. Reorders `values`.
double median(std::span<double> values);

/// Tukey's bisquare M-estimate (c = 4.685, started at the median, spread from the median absolute deviation).
struct RobustLocation {
  double value = std::numeric_limits<double>::quiet_NaN();
  double noise = 0.0;      ///< robust standard deviation
  std::vector<bool> kept;  ///< per value: finite and not an outlier
};
/// `step`: of the sensor; deviations of half of it are no outliers.
RobustLocation robust_location(std::span<const double> values, double step);

/// y = X·β with errors of which a fifth may be gross: least absolute deviations, then Tukey's bisquare. The covariance
/// is the sandwich whose scores are summed over clusters (rows that share an error), so that unequal scatter does no harm
/// (Croux, Dhaene, Hoorelbeke 2004), with residuals free of their leverage. A coefficient that few clusters decide has a
/// variance that is hardly known: its degrees of freedom are Satterthwaite's (Bell, McCaffrey 2002; Pustejovsky, Tipton 2018).
struct RobustFit {
  Eigen::VectorXd coefficients;
  Eigen::MatrixXd covariance;
  Eigen::VectorXd weights;         ///< per row, 0 … 1; 0 is an outlier
  Eigen::VectorXd freedom_counts;  ///< per coefficient

  /// Student's quantile of 97.5 % at the coefficient's degrees of freedom.
  [[nodiscard]] double quantile_factor(Eigen::Index coefficient) const;
  [[nodiscard]] Estimate estimate(Eigen::Index coefficient) const;
};
RobustFit robust_fit(const Eigen::MatrixXd& X, const Eigen::VectorXd& y, std::span<const int> cluster);

/// Share of column `column` (as its root mean square) that the other columns cannot express: 0 is collinear.
double independent_share(const Eigen::MatrixXd& X, Eigen::Index column);

}  // namespace heatsoak
