#include "identify/friction/robust_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <map>
#include <set>

namespace heatsoak {
namespace {

constexpr double kBisquare = 4.685;  // 95 % efficient where errors are normal
constexpr double kNormal = 1.4826;   // standard deviation per median absolute deviation
constexpr int kMostRounds = 60;

double bisquare_weight(double u) {
  const double share = u / kBisquare;
  return std::abs(share) < 1.0 ? (1.0 - share * share) * (1.0 - share * share) : 0.0;
}

/// Of the influence u·weight(u).
double bisquare_slope(double u) {
  const double square = u * u / (kBisquare * kBisquare);
  return square < 1.0 ? (1.0 - square) * (1.0 - 5.0 * square) : 0.0;
}

Eigen::VectorXd weighted_solution(const Eigen::MatrixXd& X, const Eigen::VectorXd& y, const Eigen::VectorXd& weights) {
  const Eigen::VectorXd root = weights.cwiseSqrt();
  return (root.asDiagonal() * X).colPivHouseholderQr().solve(root.cwiseProduct(y));
}

/// Median of the absolute residuals but the p that a fit of p coefficients can make vanish.
double residual_deviation(const Eigen::VectorXd& residuals, Eigen::Index coefficients) {
  std::vector<double> sizes(residuals.size());
  Eigen::VectorXd::Map(sizes.data(), residuals.size()) = residuals.cwiseAbs();
  std::ranges::sort(sizes);
  return kNormal * median(std::span(sizes).subspan(static_cast<std::size_t>(std::min(coefficients, residuals.size() - 1))));
}

/// Least absolute deviations by reweighting.
Eigen::VectorXd least_deviations(const Eigen::MatrixXd& X, const Eigen::VectorXd& y) {
  Eigen::VectorXd solution = weighted_solution(X, y, Eigen::VectorXd::Ones(y.size()));
  const double resolution = 1e-6 * std::max(1e-300, y.cwiseAbs().maxCoeff());
  for (int round = 0; round < kMostRounds; ++round) {
    const Eigen::VectorXd before = solution;
    solution = weighted_solution(X, y, (y - X * solution).cwiseAbs().cwiseMax(resolution).cwiseInverse());
    if ((solution - before).norm() <= 1e-7 * before.norm()) {
      break;
    }
  }
  return solution;
}

Eigen::MatrixXd sandwich(const Eigen::MatrixXd& X, const Eigen::VectorXd& residuals, const RobustFit& fit, double deviation,
                         std::span<const int> cluster) {
  const Eigen::Index size = X.cols();
  Eigen::MatrixXd bread = Eigen::MatrixXd::Zero(size, size);
  Eigen::MatrixXd weighted = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    const Eigen::MatrixXd outer = X.row(i).transpose() * X.row(i);
    bread += bisquare_slope(residuals(i) / deviation) * outer;
    weighted += fit.weights(i) * outer;
  }
  const Eigen::MatrixXd spread = weighted.completeOrthogonalDecomposition().pseudoInverse();
  std::map<int, Eigen::VectorXd> scores;
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    const double leverage = fit.weights(i) * (X.row(i) * spread * X.row(i).transpose()).value();
    const double residual = residuals(i) / std::max(0.05, 1.0 - leverage);
    const auto [place, is_new] = scores.try_emplace(cluster[static_cast<std::size_t>(i)], Eigen::VectorXd::Zero(size));
    place->second += fit.weights(i) * residual * X.row(i).transpose();
  }
  Eigen::MatrixXd meat = Eigen::MatrixXd::Zero(size, size);
  for (const auto& [key, score] : scores) {
    meat += score * score.transpose();
  }
  const Eigen::MatrixXd inverse = bread.completeOrthogonalDecomposition().pseudoInverse();
  return inverse * meat * inverse.transpose();
}

}  // namespace

bool Estimate::is_known() const { return std::isfinite(value) && std::isfinite(low) && std::isfinite(high); }

double median(std::span<double> values) {
  const auto end = std::partition(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
  const auto count = static_cast<std::size_t>(end - values.begin());
  if (count == 0) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(count / 2);
  std::nth_element(values.begin(), middle, end);
  return count % 2 == 1 ? *middle : 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

RobustLocation robust_location(std::span<const double> values, double step) {
  RobustLocation found;
  found.kept.assign(values.size(), false);
  std::vector<double> work(values.begin(), values.end());
  found.value = median(work);
  if (!std::isfinite(found.value)) {
    return found;
  }
  std::ranges::transform(values, work.begin(), [&](double value) { return std::abs(value - found.value); });
  const double deviation = std::max(kNormal * median(work), std::max(0.5 * step, 1e-12 * std::abs(found.value)));
  for (int round = 0; round < kMostRounds; ++round) {
    double sum = 0.0;
    double weight = 0.0;
    for (const double value : values) {
      if (std::isfinite(value) && deviation > 0.0) {
        const double share = bisquare_weight((value - found.value) / deviation);
        sum += share * (value - found.value);
        weight += share;
      }
    }
    if (weight <= 0.0 || std::abs(sum) <= 1e-9 * deviation * weight) {
      break;
    }
    found.value += sum / weight;
  }
  found.noise = deviation;
  for (std::size_t i = 0; i < values.size(); ++i) {
    found.kept[i] = std::isfinite(values[i]) && std::abs(values[i] - found.value) <= kBisquare * deviation;
  }
  return found;
}

double RobustFit::quantile_factor() const { return boost::math::quantile(boost::math::students_t(std::max(1.0, freedom_count)), 0.975); }

Estimate RobustFit::estimate(Eigen::Index coefficient) const {
  const double half = quantile_factor() * std::sqrt(std::max(0.0, covariance(coefficient, coefficient)));
  return {coefficients(coefficient), coefficients(coefficient) - half, coefficients(coefficient) + half};
}

RobustFit robust_fit(const Eigen::MatrixXd& X, const Eigen::VectorXd& y, std::span<const int> cluster) {
  RobustFit fit;
  // Columns of like size: weights and ranks then do not depend on the units.
  const Eigen::VectorXd size = X.colwise().norm().transpose().cwiseMax(1e-300);
  const Eigen::MatrixXd scaled = X * size.cwiseInverse().asDiagonal();
  fit.coefficients = least_deviations(scaled, y);
  const double resolution = 1e-9 * std::max(1e-300, y.cwiseAbs().maxCoeff());
  const double deviation = std::max(resolution, residual_deviation(y - scaled * fit.coefficients, X.cols()));
  for (int round = 0; round < kMostRounds; ++round) {
    fit.weights = ((y - scaled * fit.coefficients) / deviation).unaryExpr(&bisquare_weight);
    const Eigen::VectorXd before = fit.coefficients;
    fit.coefficients = weighted_solution(scaled, y, fit.weights);
    if ((fit.coefficients - before).norm() <= 1e-9 * before.norm()) {
      break;
    }
  }
  const Eigen::VectorXd residuals = y - scaled * fit.coefficients;
  fit.weights = (residuals / deviation).unaryExpr(&bisquare_weight);
  const auto clusters = static_cast<double>(std::set<int>(cluster.begin(), cluster.end()).size());
  fit.freedom_count = std::min(fit.weights.sum(), clusters) - static_cast<double>(X.cols());
  fit.covariance = sandwich(scaled, residuals, fit, deviation, cluster);
  fit.coefficients = fit.coefficients.cwiseQuotient(size);
  fit.covariance = size.cwiseInverse().asDiagonal() * fit.covariance * size.cwiseInverse().asDiagonal();
  return fit;
}

double independent_share(const Eigen::MatrixXd& X, Eigen::Index column) {
  Eigen::MatrixXd others(X.rows(), X.cols() - 1);
  others << X.leftCols(column), X.rightCols(X.cols() - 1 - column);
  const Eigen::VectorXd wanted = X.col(column);
  const double size = wanted.norm();
  if (size == 0.0 || others.cols() == 0) {
    return size == 0.0 ? 0.0 : 1.0;
  }
  return (wanted - others * others.colPivHouseholderQr().solve(wanted)).norm() / size;
}

}  // namespace heatsoak
