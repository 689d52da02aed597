// The filter gain, compared with closed forms, with the Riccati equation itself, and with the recursion that converges to it.
#include "derate/sensed/riccati.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/diagnostic.h"

namespace heatsoak::derate {
namespace {

LinearObserver scalar(double transition, double process_K2, double sensor_K2) {
  return {Eigen::MatrixXd::Constant(1, 1, transition), Eigen::RowVectorXd::Ones(1), Eigen::MatrixXd::Constant(1, 1, process_K2),
          std::sqrt(sensor_K2)};
}

TEST(Riccati, ScalarHasItsClosedForm) {
  for (const double a : {0.2, 0.9, 0.9999, 1.0, 1.3}) {
    for (const double q : {1e-6, 1e-2, 3.0}) {
      const double r = 1.3;
      // p² + p·(r − a²·r − q) − q·r = 0
      const double b = r - a * a * r - q;
      const double expected_K2 = 0.5 * (-b + std::sqrt(b * b + 4.0 * q * r));
      const double p = steady_covariance(scalar(a, q, r))(0, 0);
      EXPECT_NEAR(p, expected_K2, 1e-9 * expected_K2) << a << " " << q;
      EXPECT_NEAR(steady_kalman_gain(scalar(a, q, r))[0], expected_K2 / (expected_K2 + r), 1e-9);
    }
  }
}

LinearObserver random_observer(std::mt19937_64& engine, int size) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto matrix = [&] { return Eigen::MatrixXd::NullaryExpr(size, size, [&] { return uniform(engine); }); };
  const Eigen::MatrixXd root = matrix();
  return {0.97 * Eigen::MatrixXd::Identity(size, size) + 0.02 * matrix(),
          Eigen::RowVectorXd::NullaryExpr(size, [&] { return uniform(engine); }), 1e-3 * root * root.transpose(), 0.8};
}

TEST(Riccati, SolvesTheEquationAndIsTheLimitOfTheRecursion) {
  std::mt19937_64 engine(5);
  for (int size = 2; size <= 7; ++size) {
    const LinearObserver observer = random_observer(engine, size);
    const auto next = [&](const Eigen::MatrixXd& P) -> Eigen::MatrixXd {
      const Eigen::VectorXd seen = observer.transition * P * observer.output.transpose();
      const double variance_K2 = observer.output * P * observer.output.transpose() + observer.sensor_sd_K * observer.sensor_sd_K;
      return observer.transition * P * observer.transition.transpose() - seen * seen.transpose() / variance_K2 + observer.process_noise;
    };
    const Eigen::MatrixXd solved = steady_covariance(observer);
    EXPECT_LT((next(solved) - solved).norm(), 1e-10 * solved.norm()) << size;
    Eigen::MatrixXd recursed = Eigen::MatrixXd::Identity(size, size);
    for (int i = 0; i < 20'000; ++i) {
      recursed = next(recursed);
    }
    EXPECT_LT((recursed - solved).norm(), 1e-7 * solved.norm()) << size;
  }
}

TEST(Riccati, RefusesAnUnstableStateThatTheSensorDoesNotSee) {
  LinearObserver observer;
  observer.transition = Eigen::Vector2d(1.1, 0.9).asDiagonal();
  observer.output = Eigen::RowVector2d(0.0, 1.0);
  observer.process_noise = Eigen::MatrixXd::Identity(2, 2);
  observer.sensor_sd_K = 1.0;
  EXPECT_THROW(steady_covariance(observer), base::Failure);
}

}  // namespace
}  // namespace heatsoak::derate
