#include "estimation/evidence.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

namespace heatsoak::estimation {
namespace {

/// Returns the square factor R of a QR decomposition. A matrix with fewer rows than columns is padded with zeros.
Eigen::MatrixXd triangle_of(Eigen::MatrixXd&& tall) {
  const Eigen::Index count = tall.cols();
  if (tall.rows() < count) {
    tall.conservativeResizeLike(Eigen::MatrixXd::Zero(count, count));
  }
  Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> decomposition(tall);
  return decomposition.matrixQR().topRows(count).triangularView<Eigen::Upper>();
}

/// Whitened [by_start, columns, residual], with the prior of the start temperatures as additional rows on top.
Columns whitened(const LinearisedRun& run, const Eigen::Ref<const Columns>& columns, const Whitening& whitening, const StartPrior& start) {
  const Eigen::Index x = run.states;
  const Eigen::Index count = columns.cols();
  Columns tall(x + columns.rows(), x + count + 1);
  tall.topRows(x).setZero();
  tall.topLeftCorner(x, x).diagonal() = start.sd_K.cwiseInverse();
  tall.topRightCorner(x, 1) = start.mean_K.cwiseQuotient(start.sd_K);
  tall.bottomRows(columns.rows()) << run.by_start, columns, run.residual_K;
  whitening.apply(tall.bottomRows(columns.rows()));
  return tall;
}

double log_of_diagonal(const Eigen::MatrixXd& triangle) { return triangle.diagonal().array().abs().log().sum(); }

}  // namespace

RunEvidence run_evidence(const LinearisedRun& run, const Eigen::Ref<const Columns>& columns, const Whitening& whitening,
                         const StartPrior& start) {
  const Eigen::Index x = run.states;
  const Eigen::Index rest = columns.cols() + 1;
  const Eigen::MatrixXd triangle = triangle_of(whitened(run, columns, whitening, start));
  return {triangle.bottomRightCorner(rest, rest),
          whitening.log_determinant() + 2.0 * log_of_diagonal(triangle.topLeftCorner(x, x)) + 2.0 * start.sd_K.array().log().sum(),
          whitening.count()};
}

Eigen::VectorXd start_correction_K(const LinearisedRun& run, const Columns& columns, const Eigen::VectorXd& coefficients,
                                   const Whitening& whitening, const StartPrior& start) {
  const Eigen::Index x = run.states;
  const Eigen::MatrixXd triangle = triangle_of(whitened(run, columns, whitening, start));
  const Eigen::VectorXd right = triangle.topRightCorner(x, 1) - triangle.block(0, x, x, columns.cols()) * coefficients;
  return triangle.topLeftCorner(x, x).triangularView<Eigen::Upper>().solve(right);
}

Eigen::MatrixXd stacked(std::span<const RunEvidence> runs) {
  const Eigen::Index size = runs.front().triangle.cols();
  Eigen::MatrixXd all(size * static_cast<Eigen::Index>(runs.size()), size);
  for (std::size_t r = 0; r < runs.size(); ++r) {
    all.middleRows(static_cast<Eigen::Index>(r) * size, size) = runs[r].triangle;
  }
  return triangle_of(std::move(all));
}

LinearFit linear_fit(std::span<const RunEvidence> runs, const Eigen::VectorXd& prior_mean, const Eigen::MatrixXd& prior_precision) {
  const Eigen::MatrixXd data = stacked(runs);
  const Eigen::Index count = data.cols() - 1;
  LinearFit fit;
  fit.covariance.resize(count, count);
  double log_determinant = 0.0;
  for (const RunEvidence& run : runs) {
    log_determinant += run.log_determinant;
  }
  // Λ = Q·D·Qᵀ, so √D·Qᵀ as additional data rows is equivalent to the prior. Directions with D = 0 have no prior.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> prior(prior_precision);
  const Eigen::VectorXd root = prior.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(2 * count + 1, count + 1);
  all.topRows(count + 1) = data;
  all.bottomLeftCorner(count, count) = root.asDiagonal() * prior.eigenvectors().transpose();
  all.bottomRightCorner(count, 1) = all.bottomLeftCorner(count, count) * prior_mean;
  const Eigen::MatrixXd triangle = triangle_of(std::move(all));
  const double smallest = 1.0 / std::sqrt(kUnknownVariance);
  double log_root = 0.0;
  const Eigen::MatrixXd inverse =
      triangle.topLeftCorner(count, count).triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(count, count));
  // The norm of R⁻¹ bounds the smallest singular value: the slow SVD is needed only if some direction may be undetermined.
  if (inverse.squaredNorm() < kUnknownVariance) {
    fit.coefficients = inverse * triangle.topRightCorner(count, 1);
    fit.covariance = inverse * inverse.transpose();
    log_root = log_of_diagonal(triangle.topLeftCorner(count, count));
  } else {
    const Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::NoQRPreconditioner> svd(triangle.topLeftCorner(count, count),
                                                                           Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::VectorXd singular = svd.singularValues().cwiseMax(smallest);
    const Eigen::VectorXd right = svd.matrixU().transpose() * triangle.topRightCorner(count, 1);
    fit.coefficients = svd.matrixV() * (svd.singularValues().array() > smallest).select(right.cwiseQuotient(singular), 0.0).matrix();
    fit.covariance = svd.matrixV() * singular.cwiseAbs2().cwiseInverse().asDiagonal() * svd.matrixV().transpose();
    log_root = singular.array().log().sum();
  }
  fit.misfit = triangle(count, count) * triangle(count, count);
  double log_prior = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    log_prior += root[i] > smallest ? 2.0 * std::log(root[i]) : 0.0;
  }
  fit.log_evidence = -0.5 * (fit.misfit + log_determinant + 2.0 * log_root - log_prior);
  return fit;
}

Columns by_theta(const Model& model, const Eigen::VectorXd& theta, const Columns& by_value) {
  Columns columns = by_value;
  for (Eigen::Index i = 0; i < columns.cols(); ++i) {
    columns.col(i) *= model.slope_of(i, theta[i]);
  }
  return columns;
}

}  // namespace heatsoak::estimation
