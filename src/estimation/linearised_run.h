// Simulates a network along a measured run and linearises it: predicted sensor readings and their sensitivities.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "estimation/measured_run.h"
#include "thermal/network.h"

namespace heatsoak::estimation {

/// Row index = sample · number of sensors + sensor. Row-major, because filters proceed in time.
using Columns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Uncertainty from inputs that were not logged: covariance (x × x) added to the state at the end of an interval.
struct StateUncertainty {
  Eigen::Index interval = 0;
  Eigen::MatrixXd covariance_K2;
};

/// Dimensions: n samples, s sensors, x state nodes, q nodes with unknown heat flux, w requested parameters.
struct LinearisedRun {
  Eigen::Index states = 0;
  Eigen::Index fluxes = 0;
  std::vector<int> sensor_node;                       ///< state node of each sensor
  Eigen::MatrixXd state_C;                            ///< x × n
  Eigen::MatrixXd sensor_C;                           ///< n × s: predicted sensor readings
  Eigen::VectorXd residual_K;                         ///< n·s: measured − sensor_C; NaN if not measured
  Columns by_start;                                   ///< n·s × x: sensitivity of sensor_C to the start temperatures
  Columns by_parameter;                               ///< n·s × w: sensitivity of sensor_C in K per unit of the parameter
  std::vector<double> transition;                     ///< per interval x × x, row-major: d state(k+1) / d state(k)
  std::vector<double> injection;                      ///< per interval x × q, row-major, in K/W: response to 1 W held over the interval
  std::vector<double> duration_s;                     ///< per interval
  std::vector<StateUncertainty> state_uncertainties;  ///< in ascending order of the interval

  [[nodiscard]] Eigen::Index samples() const { return state_C.cols(); }
  [[nodiscard]] Eigen::Index sensors() const { return static_cast<Eigen::Index>(sensor_node.size()); }
};

/// Applies one more sensor error to the predicted readings, residuals and sensitivities of `sensor` in `out`.
void add_fault(const motor::SensorFault& fault, Eigen::Index sensor, const MeasuredRun& run, LinearisedRun& out);

/// Simulates from `start_C` (°C, per state node) and linearises along the result. Includes the sensor errors stated in the run.
/// `parameters` are in the network's order; `wanted` and `flux_nodes` are indices into its lists of parameters and nodes. Throws Failure
/// (numerics_failed) if the temperatures diverge. Allocates memory once per run, not per sample.
LinearisedRun linearise(const thermal::Network& network, std::span<const double> parameters, std::span<const int> wanted,
                        std::span<const int> flux_nodes, std::span<const double> start_C, const MeasuredRun& run);

/// Linearises along a given path (states × samples, in °C), which the network need not follow by itself. sensor_C
/// is the solution of these linear equations from the start of the path.
LinearisedRun linearise_along(const thermal::Network& network, std::span<const double> parameters, std::span<const int> wanted,
                              std::span<const int> flux_nodes, const Eigen::MatrixXd& path_C, const MeasuredRun& run);

}  // namespace heatsoak::estimation
