#include "friction/robust_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <map>

#include "base/confidence.h"

namespace heatsoak::friction {
namespace {

constexpr double kBisquare = 4.685;  // 95 % efficiency for normal errors
constexpr double kNormal = 1.4826;   // standard deviation per median absolute deviation
constexpr int kMostRounds = 60;
constexpr double kLeastLeft_share = 0.05;  ///< smallest share of an error that is assumed to remain in its residual

double bisquare_weight(double u) {
  const double share = u / kBisquare;
  return std::abs(share) < 1.0 ? (1.0 - share * share) * (1.0 - share * share) : 0.0;
}

/// Derivative of the influence function u·weight(u).
double bisquare_slope(double u) {
  const double square = u * u / (kBisquare * kBisquare);
  return square < 1.0 ? (1.0 - square) * (1.0 - 5.0 * square) : 0.0;
}

Eigen::VectorXd weighted_solution(const Eigen::MatrixXd& X, const Eigen::VectorXd& y, const Eigen::VectorXd& weights) {
  const Eigen::VectorXd root = weights.cwiseSqrt();
  return (root.asDiagonal() * X).colPivHouseholderQr().solve(root.cwiseProduct(y));
}

/// Robust standard deviation: median absolute residual without the p smallest ones, which a fit of p coefficients can make vanish.
double residual_deviation(const Eigen::VectorXd& residuals, Eigen::Index coefficients) {
  std::vector<double> sizes(residuals.size());
  Eigen::VectorXd::Map(sizes.data(), residuals.size()) = residuals.cwiseAbs();
  std::ranges::sort(sizes);
  return kNormal * median(std::span(sizes).subspan(static_cast<std::size_t>(std::min(coefficients, residuals.size() - 1))));
}

/// Least absolute deviations by iteratively reweighted least squares.
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

/// Returns (I − U·Uᵀ)⁻¹·values, the leave-one-cluster-out correction (CR3). Without it, clusters with high leverage hide their scatter.
Eigen::MatrixXd without_leverage(const Eigen::MatrixXd& U, const Eigen::MatrixXd& values) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> of(U.transpose() * U);
  const Eigen::VectorXd factors = of.eigenvalues().unaryExpr([](double leverage) {
    const double left = std::max(kLeastLeft_share, 1.0 - leverage);
    return leverage < 1e-12 ? 0.0 : (1.0 / left - 1.0) / leverage;
  });
  return values + U * of.eigenvectors() * factors.asDiagonal() * of.eigenvectors().transpose() * U.transpose() * values;
}

/// Sets covariance and freedom_counts.
void add_sandwich(const Eigen::MatrixXd& X, const Eigen::VectorXd& residuals, double deviation, std::span<const int> cluster,
                  RobustFit& fit) {
  const Eigen::Index size = X.cols();
  const Eigen::VectorXd root = fit.weights.cwiseSqrt();
  const Eigen::MatrixXd weighted = root.asDiagonal() * X;
  const Eigen::VectorXd scaled_residuals = root.cwiseProduct(residuals);
  const Eigen::VectorXd slopes = (residuals / deviation).unaryExpr(&bisquare_slope);
  const Eigen::MatrixXd bread = (X.transpose() * slopes.asDiagonal() * X).completeOrthogonalDecomposition().pseudoInverse();
  // U is an orthonormal basis of the columns of `weighted`; U·Uᵀ is the hat matrix.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> squares(weighted.transpose() * weighted);
  const double least = 1e-12 * squares.eigenvalues().maxCoeff();
  const Eigen::VectorXd inverse_roots =
      squares.eigenvalues().unaryExpr([least](double square) { return square > least ? 1.0 / std::sqrt(square) : 0.0; });
  const Eigen::MatrixXd U = weighted * squares.eigenvectors() * inverse_roots.asDiagonal();

  std::map<int, std::vector<Eigen::Index>> rows;
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    rows[cluster[static_cast<std::size_t>(i)]].push_back(i);
  }
  // An estimated variance is eᵀ·Q·e. For errors e of equal variance its mean is proportional to tr Q, its variance to tr Q².
  Eigen::MatrixXd meat = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd trace = Eigen::VectorXd::Zero(size);
  Eigen::VectorXd trace_of_square = Eigen::VectorXd::Zero(size);
  std::vector<Eigen::MatrixXd> followed(static_cast<std::size_t>(size), Eigen::MatrixXd::Zero(size, size));
  for (const auto& [key, members] : rows) {
    const Eigen::MatrixXd U_here = U(members, Eigen::all);
    const Eigen::MatrixXd shares = without_leverage(U_here, weighted(members, Eigen::all));
    const Eigen::VectorXd score = shares.transpose() * scaled_residuals(members);
    meat += score * score.transpose();
    const Eigen::MatrixXd pulls = shares * bread;
    const Eigen::MatrixXd along = U_here.transpose() * pulls;
    for (Eigen::Index k = 0; k < size; ++k) {
      const double all = pulls.col(k).squaredNorm();
      const double lost = along.col(k).squaredNorm();
      trace(k) += all - lost;
      trace_of_square(k) += all * all - 2.0 * all * lost;
      followed[static_cast<std::size_t>(k)] += along.col(k) * along.col(k).transpose();
    }
  }
  for (Eigen::Index k = 0; k < size; ++k) {
    trace_of_square(k) += followed[static_cast<std::size_t>(k)].squaredNorm();
  }
  fit.covariance = bread * meat * bread.transpose();
  fit.freedom_counts = trace.cwiseAbs2().cwiseQuotient(trace_of_square);
}

}  // namespace

Estimate estimate_around(double value, double spread) {
  return {value, std::isfinite(spread) ? std::optional(Interval{value - spread, value + spread}) : std::nullopt};
}

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
  double location = median(work);
  if (!std::isfinite(location)) {
    return found;
  }
  std::ranges::transform(values, work.begin(), [&](double value) { return std::abs(value - location); });
  const double deviation = std::max(kNormal * median(work), std::max(0.5 * step, 1e-12 * std::abs(location)));
  for (int round = 0; round < kMostRounds; ++round) {
    double sum = 0.0;
    double weight = 0.0;
    for (const double value : values) {
      if (std::isfinite(value) && deviation > 0.0) {
        const double share = bisquare_weight((value - location) / deviation);
        sum += share * (value - location);
        weight += share;
      }
    }
    if (weight <= 0.0 || std::abs(sum) <= 1e-9 * deviation * weight) {
      break;
    }
    location += sum / weight;
  }
  found.value = location;
  found.noise = deviation;
  for (std::size_t i = 0; i < values.size(); ++i) {
    found.kept[i] = std::isfinite(values[i]) && std::abs(values[i] - location) <= kBisquare * deviation;
  }
  return found;
}

double RobustFit::quantile_factor(Eigen::Index coefficient) const {
  return boost::math::quantile(boost::math::students_t(std::max(1.0, freedom_counts(coefficient))), base::kBoundConfidence_share);
}

Estimate RobustFit::estimate(Eigen::Index coefficient) const {
  const double half = quantile_factor(coefficient) * std::sqrt(std::max(0.0, covariance(coefficient, coefficient)));
  return estimate_around(coefficients(coefficient), half);
}

RobustFit robust_fit(const Eigen::MatrixXd& X, const Eigen::VectorXd& y, std::span<const int> cluster) {
  RobustFit fit;
  // Normalise the columns, so that weights and ranks do not depend on units.
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
  add_sandwich(scaled, residuals, deviation, cluster, fit);
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

}  // namespace heatsoak::friction
