// Steady-state Kalman gain of a linear time-invariant observer with one sensor.
#pragma once

#include <Eigen/Core>

namespace heatsoak {

/// x(k+1) = transition·x(k) + w, y(k) = output·x(k) + v with covariances of w and v. State and noise share one unit of temperature.
struct LinearObserver {
  Eigen::MatrixXd transition;     ///< n × n, over one period
  Eigen::RowVectorXd output;      ///< 1 × n
  Eigen::MatrixXd process_noise;  ///< n × n, positive semidefinite, K²
  double sensor_sd_K = 0.0;       ///< standard deviation of v
};

/// Covariance of the state before the reading: the stabilising solution of P = A·P·Aᵀ − A·P·Cᵀ·(C·P·Cᵀ + R)⁻¹·C·P·Aᵀ + Q.
/// Structure-preserving doubling (Chu, Fan, Lin, Wang, Int. J. Control 77 (2004) 767): quadratic convergence, matrices of the state's size.
/// Throws Failure (numerics_failed) if it does not converge, which means that the sensor does not see an unstable state.
Eigen::MatrixXd steady_covariance(const LinearObserver& observer);

/// Correction of the state per unit of (reading − predicted reading).
Eigen::VectorXd steady_kalman_gain(const LinearObserver& observer);

}  // namespace heatsoak
