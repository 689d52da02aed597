#include "attribution/changed_parameters.h"

namespace heatsoak {

Prior with_prior_sd(const Prior& prior, Eigen::Index coordinate, double sheet_sd) {
  // Inverse of (Λ⁻¹ + s²·e·eᵀ) without computing Λ⁻¹ (Sherman and Morrison 1950).
  Prior doubted = prior;
  const Eigen::VectorXd column = prior.precision.col(coordinate);
  doubted.precision -= column * column.transpose() * (sheet_sd * sheet_sd / (1.0 + sheet_sd * sheet_sd * column[coordinate]));
  return doubted;
}

std::vector<Eigen::Index> well_known_values(const ExtendedModel& model, double sheet_sd) {
  std::vector<Eigen::Index> known;
  const Eigen::MatrixXd precision = model.prior().precision;
  for (Eigen::Index i = 0; i < model.model.free_count(); ++i) {
    const bool is_well_known = precision(i, i) * sheet_sd * sheet_sd > 4.0;
    if (is_well_known && model.model.free[static_cast<std::size_t>(i)].by_log) {
      known.push_back(i);
    }
  }
  return known;
}

}  // namespace heatsoak
