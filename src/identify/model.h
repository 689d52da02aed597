// What is fitted: a network with some of its parameters free, and what was known of them before.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "thermal/network.h"

namespace heatsoak {

/// A free parameter as a coordinate θ: the logarithm of a positive value, or a value that may be 0 in units of `scale`.
struct FreeParameter {
  int place = 0;  ///< in the network's list of parameters
  bool by_log = true;
  double scale = 1.0;  ///< of the value, in the parameter's unit
  double low = 0.0;    ///< of the value
  double high = 0.0;   ///< of the value
};

/// Gaussian in θ; a precision of 0 knows nothing.
struct Prior {
  Eigen::VectorXd mean;
  Eigen::MatrixXd precision;
};

struct Model {
  Network network;
  std::vector<double> values;  ///< of all parameters of the network
  std::vector<FreeParameter> free;
  Prior prior;
  std::vector<int> flux_nodes;            ///< that unknown heat may reach
  std::vector<double> least_flux_W = {};  ///< of it, rms: known to be there, though not when; empty: none

  [[nodiscard]] Eigen::Index free_count() const { return static_cast<Eigen::Index>(free.size()); }
  [[nodiscard]] const std::string& name(Eigen::Index parameter) const;
  [[nodiscard]] Eigen::VectorXd theta() const;
  [[nodiscard]] double theta_of(Eigen::Index parameter, double value) const;
  [[nodiscard]] double value_of(Eigen::Index parameter, double theta_value) const;
  /// d value / dθ.
  [[nodiscard]] double slope_of(Eigen::Index parameter, double theta_value) const;
  /// `values` with the free ones at θ.
  [[nodiscard]] std::vector<double> values_at(const Eigen::VectorXd& theta) const;
  /// Frees one more parameter at its present value, known before with `spread` as standard deviation of θ around it.
  void set_free(const FreeParameter& parameter, double spread);
};

}  // namespace heatsoak
