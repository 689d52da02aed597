// Residual tests. If the model is correct, the whitened innovations are independent with unit variance; each test checks one consequence of
// that.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace heatsoak::estimation {

/// Results for one sensor. With fewer than 160 samples only `count` is set.
struct InnovationTests {
  std::string signal;
  int count = 0;
  double variance_ratio = 0.0;         ///< variance of the innovations; 1 if the noise level is correct
  double ljung_box_probability = 0.0;  ///< p-value of the autocorrelation up to lag 40 (Ljung and Box 1978)
  /// Largest distance of the cumulative periodogram from a straight line, divided by the 95 % Kolmogorov band. Not white noise if above 1.
  double periodogram_ratio = 0.0;
  double kurtosis_ratio = 0.0;  ///< kurtosis divided by that of a normal distribution
  /// Inputs with their largest cross-correlation, largest first. Listed if at least 4 of the lags 0 to 20 exceed 2/√n.
  std::vector<std::pair<std::string, double>> correlated_with;
};

struct NamedInput {
  std::string name;
  Eigen::VectorXd values;  ///< one per innovation; NaN: not known
};

/// Largest lag of a correlation, in samples. This number of missing samples between two runs keeps them apart.
inline constexpr int kMostLag = 40;

/// Tests one sensor. `innovation` is in order of time, NaN for a missing sample.
InnovationTests test_innovations(std::string signal, const Eigen::VectorXd& innovation, const std::vector<NamedInput>& inputs);

}  // namespace heatsoak::estimation
