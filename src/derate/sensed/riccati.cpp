#include "derate/sensed/riccati.h"

#include <Eigen/LU>

#include "base/diagnostic.h"

namespace heatsoak::derate {

Eigen::MatrixXd steady_covariance(const LinearObserver& observer) {
  constexpr int kMostDoublings = 60;
  constexpr double kConverged = 1e-13;
  constexpr double kMost_K2 = 1e12;
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(observer.transition.rows(), observer.transition.cols());
  Eigen::MatrixXd A = observer.transition.transpose();
  Eigen::MatrixXd G = observer.output.transpose() * observer.output / (observer.sensor_sd_K * observer.sensor_sd_K);
  Eigen::MatrixXd H = observer.process_noise;
  for (int i = 0; i < kMostDoublings; ++i) {
    const Eigen::PartialPivLU<Eigen::MatrixXd> lu(identity + G * H);
    const Eigen::MatrixXd solved_A = lu.solve(A);
    const Eigen::MatrixXd change = A.transpose() * H * solved_A;
    G += A * lu.solve(G) * A.transpose();
    A = A * solved_A;
    H += change;
    // The variance of an unstable state that is not observable grows until it overflows.
    if (H.norm() < kMost_K2 && change.norm() <= kConverged * H.norm()) {
      return 0.5 * (H + H.transpose());
    }
  }
  throw base::Failure(base::ExitCode::numerics_failed,
                      "the Riccati equation of the sensor's gain does not converge; use a sensor at another node");
}

Eigen::VectorXd steady_kalman_gain(const LinearObserver& observer) {
  const Eigen::MatrixXd covariance = steady_covariance(observer);
  const Eigen::VectorXd seen = covariance * observer.output.transpose();
  return seen / (observer.output.dot(seen) + observer.sensor_sd_K * observer.sensor_sd_K);
}

}  // namespace heatsoak::derate
