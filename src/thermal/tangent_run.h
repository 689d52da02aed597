// Simulates a network over the rows of a log together with the exact derivatives of the result, for fits and filters.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "thermal/linearised.h"
#include "thermal/network.h"

namespace heatsoak::thermal {

/// Result of one interval; n state nodes, w wanted parameters, q heated nodes.
struct NetworkStep {
  Eigen::VectorXd state_C;       ///< n, temperatures at the end
  Eigen::MatrixXd by_start;      ///< n × n, derivative of state_C with respect to the start temperatures: the transition matrix
  Eigen::MatrixXd by_parameter;  ///< n × (w + q), the same for the wanted parameters (per unit), then for the heats (K/W)
};

/// Classical Runge-Kutta method together with its derivatives; steps are short compared with the fastest time constant. Very short
/// intervals use Heun's third-order method.
class TangentRun {
 public:
  /// `wanted`: indices in the network's list of parameters. `heated`: nodes for which the response to an unknown heat flux, constant over
  /// the interval, is computed.
  TangentRun(const Network& network, std::span<const double> parameters, std::span<const int> wanted, std::span<const int> heated = {});

  /// The result is valid until the next call. Throws Failure (numerics_failed) if a temperature leaves −273 to 1000 °C or the interval
  /// would need more than 10 000 steps. Does not allocate.
  const NetworkStep& over(std::span<const double> start_C, double duration_s, const OperatingPoint<double>& at);

 private:
  /// `slope_` must already hold the rates at the beginning of the step.
  void one_step(double step_s, bool is_short, const OperatingPoint<double>& at);
  void set_slope(const OperatingPoint<double>& at, const Eigen::VectorXd& state_C);

  const Network& network_;
  std::vector<double> parameters_;
  std::vector<int> wanted_;
  std::vector<int> heated_;
  NetworkStep step_;
  Linearised slope_;
  Eigen::VectorXd stage_C_;
  Eigen::VectorXd rate_sum_;
  Eigen::MatrixXd rate_by_start_, by_start_sum_;
  Eigen::MatrixXd direct_;  ///< derivative of the rates with respect to the wanted parameters and the heats at a constant state
  Eigen::MatrixXd rate_by_parameter_, by_parameter_sum_;
};

}  // namespace heatsoak::thermal
