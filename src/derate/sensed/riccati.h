// Steady-state Kalman gain of a linear time-invariant observer with one sensor.
#pragma once

#include <Eigen/Core>

namespace heatsoak::derate {

/// System x(k+1) = transition·x(k) + w, y(k) = output·x(k) + v, with independent noise w and v. State and noise are temperatures in K.
struct LinearObserver {
  Eigen::MatrixXd transition;     ///< n × n, over one period
  Eigen::RowVectorXd output;      ///< 1 × n
  Eigen::MatrixXd process_noise;  ///< n × n, positive semidefinite, K²
  double sensor_sd_K = 0.0;       ///< standard deviation of v
};

/// Returns the covariance of the predicted state in K²: the stabilising solution of P = A·P·Aᵀ − A·P·Cᵀ·(C·P·Cᵀ + R)⁻¹·C·P·Aᵀ + Q. Method:
/// structure-preserving doubling with quadratic convergence (Chu, Fan, Lin, Wang, Int. J. Control 77 (2004) 767). Throws Failure
/// (numerics_failed) if it does not converge, which means that an unstable state is not observable by the sensor.
Eigen::MatrixXd steady_covariance(const LinearObserver& observer);

/// Returns the correction of the state per unit of innovation (reading − predicted reading).
Eigen::VectorXd steady_kalman_gain(const LinearObserver& observer);

}  // namespace heatsoak::derate
