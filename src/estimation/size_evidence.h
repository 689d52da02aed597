// Evidence of effects with unknown sizes in a linear model, from the reduced normal equations of their columns.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace heatsoak::estimation {

struct Reduced;

/// Returns ½ vᵀp − ½ ln|K| + ½ ln|Λ| + Σ ln 2Φ(p/sd), the sum over sizes with a sign, with K = M + Λ and K·p = v. `products` is M, `right`
/// is v, `precision` is Λ. Writes p to `sizes` if given. Returns −∞ if K or Λ is not positive definite.
double size_gain_nats(const Eigen::MatrixXd& products, const Eigen::VectorXd& right, const Eigen::MatrixXd& precision,
                      const std::vector<bool>& has_sign, Eigen::VectorXd* sizes = nullptr);

/// Same for the columns of `point` with these indices and independent priors. `precision`: diagonal of Λ.
double size_gain_nats(const Reduced& point, std::span<const Eigen::Index> columns, const Eigen::VectorXd& precision,
                      const std::vector<bool>& has_sign, Eigen::VectorXd* sizes = nullptr);

}  // namespace heatsoak::estimation
