// Parameters of the file that the runs contradict, because of another mounting, another specimen or a loose terminal. A calibrated file has
// narrow priors; without this test, such a change would be mistaken for an effect.
#pragma once

#include <string>
#include <vector>

#include "estimation/model_along_run.h"

namespace heatsoak::attribution {

/// A free parameter whose narrow prior from the file is widened to the uncertainty of a data sheet.
struct ChangedParameter {
  Eigen::Index coordinate = 0;  ///< index in θ
  std::string name;             ///< name in the network, "stator_ambient.thermal_resistance"
  std::string unit;
  double gain_nats = 0.0;  ///< ln evidence with the wide prior minus ln evidence with the file's prior
  /// Values of the parameter: of the file, of the final fit, and the fit's 95 % interval; all in `unit`.
  double before = 0.0;
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;
};

/// Returns the coordinates of positive parameters whose prior standard deviation is less than half of `sheet_sd`. Both are standard
/// deviations of the logarithm; `sheet_sd` is that of a value on a data sheet.
std::vector<Eigen::Index> well_known_values(const estimation::Model& model, double sheet_sd);

}  // namespace heatsoak::attribution
