#include "attribution/changed_parameters.h"

namespace heatsoak::attribution {

std::vector<Eigen::Index> well_known_values(const estimation::Model& model, double sheet_sd) {
  std::vector<Eigen::Index> known;
  const Eigen::MatrixXd precision = model.full_prior().precision;
  for (Eigen::Index i = 0; i < model.network_count(); ++i) {
    const bool is_well_known = precision(i, i) * sheet_sd * sheet_sd > 4.0;
    if (is_well_known && model.free[static_cast<std::size_t>(i)].by_log) {
      known.push_back(i);
    }
  }
  return known;
}

}  // namespace heatsoak::attribution
