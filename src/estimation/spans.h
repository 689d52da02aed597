// Views between Eigen's vectors and spans, for functions of layers that do not use Eigen.
#pragma once

#include <Eigen/Core>
#include <span>

namespace heatsoak::estimation {

/// Returns a view of a vector or of a column of a matrix.
inline std::span<double> as_span(Eigen::Ref<Eigen::VectorXd> values) { return {values.data(), static_cast<std::size_t>(values.size())}; }

inline Eigen::Map<const Eigen::VectorXd> as_vector(std::span<const double> values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

}  // namespace heatsoak::estimation
