// Figures of the file that the runs contradict: another mounting, another motor of the type, a terminal that has worked loose. A file that
// was calibrated knows its figures well, and what has changed since then must not pass for an effect.
#pragma once

#include <string>
#include <vector>

#include "attribution/extended_model.h"

namespace heatsoak {

/// A free parameter of the model that is better known than a sheet knows it, given back the uncertainty of a sheet.
struct ChangedParameter {
  Eigen::Index coordinate = 0;  ///< of θ
  std::string name;             ///< of the network's parameter, "stator_ambient.thermal_resistance"
  std::string unit;
  double gain_nats = 0.0;  ///< ln evidence with a wide prior for this parameter, minus that with the file's prior
  double before = 0.0;
  double value = 0.0;  ///< of the final fit, with its 95 % interval
  double low = 0.0;
  double high = 0.0;
};

/// Prior with the uncertainty of a data sheet (`sheet_sd`, of the logarithm) added to one coordinate.
Prior with_prior_sd(const Prior& prior, Eigen::Index coordinate, double sheet_sd);

/// Coordinates of figures that are known more than twice as well as a sheet knows them.
std::vector<Eigen::Index> well_known_values(const ExtendedModel& model, double sheet_sd);

}  // namespace heatsoak
