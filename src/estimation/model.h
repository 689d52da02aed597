// Model to be fitted: a network, its free parameters, errors of the sensors, and what differs between runs.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "estimation/run_deviation.h"
#include "motor/sensor_effect.h"
#include "thermal/network.h"

namespace heatsoak::estimation {

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

  /// Adds the variance `sd`² to one coordinate.
  void widen(Eigen::Index coordinate, double sd);
};

/// An effect of the network that acts only in runs with the condition.
struct ConditionalTerm {
  std::string effect_name;
  int place = 0;           ///< index of the parameter that switches the effect off
  double off_value = 0.0;  ///< value of that parameter at which the effect is zero
  Condition condition;
};

/// A sensor error whose size is a coordinate of the model.
struct SensorTerm {
  const motor::SensorEffectType* type = nullptr;
  double value = 0.0;      ///< size, in the unit of the type
  double spread_sd = 1.0;  ///< prior standard deviation around 0, in the same unit
};

/// Coordinates θ, in this order: free parameters of the network; sensor errors, in typical sizes; run deviations, in units of their type's
/// `usual`. A calibration has coordinates of the first kind only; a diagnosis adds the others.
struct Model {
  thermal::Network network;
  std::vector<double> values;  ///< all parameters of the network, in its order
  std::vector<FreeParameter> free;
  Prior prior;                            ///< free parameters of the network only; full_prior() includes the other coordinates
  std::vector<int> flux_nodes;            ///< nodes with an unknown heat flux
  std::vector<double> least_flux_W = {};  ///< lower limit of the flux's RMS, for heat that exists at unknown times; empty: none
  std::vector<ConditionalTerm> conditional = {};
  std::vector<SensorTerm> sensors = {};
  std::vector<RunDeviation> deviations = {};
  std::vector<std::string> columns = {};  ///< names of the log columns that curves use, see set_columns()

  /// Number of free parameters of the network.
  [[nodiscard]] Eigen::Index network_count() const { return static_cast<Eigen::Index>(free.size()); }
  /// Number of all coordinates.
  [[nodiscard]] Eigen::Index free_count() const { return first_deviation() + static_cast<Eigen::Index>(deviations.size()); }
  [[nodiscard]] Eigen::Index first_deviation() const { return network_count() + static_cast<Eigen::Index>(sensors.size()); }
  [[nodiscard]] Eigen::VectorXd theta() const;
  void set_theta(const Eigen::VectorXd& theta);
  /// Returns the prior of all coordinates. The mean is absolute.
  [[nodiscard]] Prior full_prior() const;
  /// Lower or upper bound of a coordinate; the lower one may be −∞.
  [[nodiscard]] double low(Eigen::Index coordinate) const;
  [[nodiscard]] double high(Eigen::Index coordinate) const;

  // Free parameters of the network.
  [[nodiscard]] const std::string& name(Eigen::Index parameter) const;
  [[nodiscard]] double theta_of(Eigen::Index parameter, double value) const;
  [[nodiscard]] double value_of(Eigen::Index parameter, double theta_value) const;
  /// Derivative d(value) / dθ at θ = `theta_value`.
  [[nodiscard]] double slope_of(Eigen::Index parameter, double theta_value) const;
  /// Returns `values` with the free parameters set from θ.
  [[nodiscard]] std::vector<double> values_at(const Eigen::VectorXd& theta) const;
  /// Returns the network's parameters in that run, with conditional effects and run deviations applied.
  [[nodiscard]] std::vector<double> values_in(const MeasuredRun& run) const;
  /// Frees one more parameter. Its prior is centred on the present value with standard deviation `spread` in θ.
  void set_free(const FreeParameter& parameter, double spread);
};

}  // namespace heatsoak::estimation
