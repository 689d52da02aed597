// Second pass of the screening, with a fitted model: detects converters that repeat one value while the temperature changes, and outliers
// that are visible only against a prediction. The first pass, Screening, needs no model.
#pragma once

#include <vector>

#include "estimation/linearised_run.h"

namespace heatsoak::estimation {

struct ModelScreeningRules {
  double shift_sd_K = 0.3;  ///< standard deviation of the model's error over a sequence of equal readings
  double smooth_time_scale_s = 200.0;
  double loose_ratio = 4.0;  ///< unknown heat of the outlier test divided by that of the smoother
  double loose_time_scale_s = 60.0;
};

/// Returns a weight per run and sample (n·s): 1, or 0 for a wrong sample. `fitted` are free runs of a model whose missing heat is at most
/// about `unknown_W` (RMS per node, varying over minutes). A sequence of equal readings is excluded from its own prediction. If more than
/// `most_rejected_share` of a sensor's samples would be rejected, all of them are kept.
std::vector<Eigen::VectorXd> weights_by_model(const std::vector<LinearisedRun>& fitted, const std::vector<MeasuredRun>& runs,
                                              double unknown_W, const ModelScreeningRules& rules = {});

}  // namespace heatsoak::estimation
