// A network over the rows of a log, with the exact derivatives of what was computed: for fits and for filters.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "thermal/network.h"

namespace heatsoak {

/// From the start of an interval to its end; n state nodes, w wanted parameters, q heated nodes.
struct NetworkStep {
  Eigen::VectorXd state_C;       ///< n, at the end
  Eigen::MatrixXd by_start;      ///< n × n: derivatives of it by the temperatures at the start, the transition matrix
  Eigen::MatrixXd by_parameter;  ///< n × (w + q): by the wanted parameters, per unit, with the start held; then by heat, in K/W
};

/// The classical Runge-Kutta method with its own derivatives; steps short against the fastest time constant. Very short ones are Heun's of
/// third order.
class TangentRun {
 public:
  /// `wanted`: places in the network's list of parameters. `heated`: nodes whose response to a heat that nobody knows, held over the
  /// interval, is asked for.
  TangentRun(const Network& network, std::span<const double> parameters, std::span<const int> wanted, std::span<const int> heated = {});

  /// The result is valid until the next call. Throws Failure (numerics_failed) where temperatures leave −273 … 1000 °C or the
  /// network is too fast for any sensible number of steps. Does not allocate.
  const NetworkStep& over(std::span<const double> start_C, double duration_s, const OperatingPoint<double>& at);

 private:
  /// `slope_` is that of the step's beginning already.
  void one_step(double step_s, bool is_short, const OperatingPoint<double>& at);
  void set_slope(const OperatingPoint<double>& at, const Eigen::VectorXd& state_C);

  const Network& network_;
  std::vector<double> parameters_;
  std::vector<int> wanted_;
  std::vector<int> heated_;
  NetworkStep step_;
  Linearised slope_;
  Eigen::VectorXd stage_C_;
  Eigen::MatrixXd stage_by_start_;
  Eigen::MatrixXd stage_by_parameter_;
  Eigen::VectorXd rate_sum_;
  Eigen::MatrixXd rate_by_start_, by_start_sum_;
  Eigen::MatrixXd rate_by_parameter_, by_parameter_sum_;
};

}  // namespace heatsoak
