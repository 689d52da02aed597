// Model to be fitted: a network, its free parameters and their prior.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "thermal/network.h"

namespace heatsoak {

/// Free parameter with coordinate θ: ln(value) for positive values (`by_log`), or value / scale for values that may be 0.
struct FreeParameter {
  int place = 0;  ///< index in the network's list of parameters
  bool by_log = true;
  double scale = 1.0;  ///< in the parameter's unit; unused if by_log
  double low = 0.0;    ///< lower bound of the value
  double high = 0.0;   ///< upper bound of the value
};

/// Gaussian prior in θ; a precision of 0 means no prior knowledge.
struct Prior {
  Eigen::VectorXd mean;
  Eigen::MatrixXd precision;
};

struct Model {
  Network network;
  std::vector<double> values;  ///< all parameters of the network, in its order
  std::vector<FreeParameter> free;
  Prior prior;
  std::vector<int> flux_nodes;            ///< nodes with an unknown heat flux
  std::vector<double> least_flux_W = {};  ///< lower limit of the flux's RMS, for heat that exists at unknown times; empty: none

  [[nodiscard]] Eigen::Index free_count() const { return static_cast<Eigen::Index>(free.size()); }
  [[nodiscard]] const std::string& name(Eigen::Index parameter) const;
  [[nodiscard]] Eigen::VectorXd theta() const;
  [[nodiscard]] double theta_of(Eigen::Index parameter, double value) const;
  [[nodiscard]] double value_of(Eigen::Index parameter, double theta_value) const;
  /// Derivative d(value) / dθ at θ = `theta_value`.
  [[nodiscard]] double slope_of(Eigen::Index parameter, double theta_value) const;
  /// Returns `values` with the free parameters set from θ.
  [[nodiscard]] std::vector<double> values_at(const Eigen::VectorXd& theta) const;
  /// Frees one more parameter. Its prior is centred on the present value with standard deviation `spread` in θ.
  void set_free(const FreeParameter& parameter, double spread);
};

}  // namespace heatsoak
