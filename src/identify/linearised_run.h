// A network run along a measured run: what the sensors should have shown, and how that moves with everything unknown.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "identify/measured_run.h"
#include "thermal/network.h"

namespace heatsoak {

/// Row = sample · sensors + sensor. Stored row by row, for filters go through time.
using Columns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Of inputs that nobody logged: covariance that the state gains by the end of the interval, x × x.
struct StateDoubt {
  Eigen::Index interval = 0;
  Eigen::MatrixXd covariance_K2;
};

/// n samples, s sensors, x state nodes, q nodes that unknown heat may reach, w wanted parameters.
struct LinearisedRun {
  Eigen::Index states = 0;
  Eigen::Index fluxes = 0;
  std::vector<int> sensor_node;    ///< of each sensor
  Eigen::MatrixXd state_C;         ///< x × n
  Eigen::MatrixXd shown_C;         ///< n × s: what the sensors should have shown
  Eigen::VectorXd residual_K;      ///< n·s: measured − shown_C; NaN where nothing was measured
  Columns by_start;                ///< n·s × x: of the prediction, by the temperatures at the start
  Columns by_parameter;            ///< n·s × w, per unit of the parameter
  std::vector<double> transition;  ///< per interval x × x, row by row: d state(k+1) / d state(k)
  std::vector<double> injection;   ///< per interval x × q, row by row, K/W: response to 1 W held over the interval
  std::vector<double> duration_s;  ///< per interval
  std::vector<StateDoubt> doubts;  ///< by interval, ascending

  [[nodiscard]] Eigen::Index samples() const { return state_C.cols(); }
  [[nodiscard]] Eigen::Index sensors() const { return static_cast<Eigen::Index>(sensor_node.size()); }
};

/// One fault more of a sensor, upon what `out` foretells of it and how that moves.
void add_fault(const SensorFault& fault, Eigen::Index sensor, const MeasuredRun& run, LinearisedRun& out);

/// The sensors have the faults that the run states for them. `parameters` as the network lists them; `wanted` and `flux_nodes` are places
/// in its lists. Throws Failure (numerics_failed) where the temperatures run away. Allocates for the whole run, not per sample.
LinearisedRun linearise(const Network& network, std::span<const double> parameters, std::span<const int> wanted,
                        std::span<const int> flux_nodes, std::span<const double> start_C, const MeasuredRun& run);

/// The same about a path (states × samples, in °C) that the network need not follow by itself: the equations are linearised along it, and
/// shown_C is what the linear equations make of the path's own start.
LinearisedRun linearise_along(const Network& network, std::span<const double> parameters, std::span<const int> wanted,
                              std::span<const int> flux_nodes, const Eigen::MatrixXd& path_C, const MeasuredRun& run);

}  // namespace heatsoak
