// Is what a fit leaves still telling something? Tests on whitened innovations, which are independent and of variance 1
// where model, noise and unknown heat are right.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace heatsoak {

struct InnovationTests {
  std::string signal;
  int count = 0;
  double variance_ratio = 0.0;         ///< of the innovations; 1 where the noise level is right
  double ljung_box_probability = 0.0;  ///< of correlations up to lag 40 as large by chance
  /// Largest distance of the cumulated periodogram from the straight line, in units of the 95 % Kolmogorov band: above 1 is not white.
  double periodogram_ratio = 0.0;
  double kurtosis_ratio = 0.0;  ///< of a normal distribution: 1
  /// Inputs whose correlation with the innovations exceeds 2/√n at some lag of 0 … 20 more often than chance does, by name, largest first.
  std::vector<std::pair<std::string, double>> correlated_with;
};

struct NamedInput {
  std::string name;
  Eigen::VectorXd values;  ///< one per innovation; NaN: not known
};

/// `innovation`: in the order of time; NaN where there was no sample.
InnovationTests test_innovations(std::string signal, const Eigen::VectorXd& innovation, const std::vector<NamedInput>& inputs);

}  // namespace heatsoak
