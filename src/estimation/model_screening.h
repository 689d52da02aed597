// Second pass of the screening, with a fitted model: detects converters that repeat one value while the temperature changes, and outliers
// that are visible only against a prediction. The first pass, Screening, needs no model.
#pragma once

#include <vector>

#include "estimation/linearised_run.h"

namespace heatsoak::estimation {

/// If more samples than this would be rejected, the model is wrong rather than the samples, and none is rejected.
inline constexpr double kMostRejected_share = 0.1;

struct ModelScreeningRules {
  int least_equal = 8;        ///< shortest sequence of equal readings that is tested
  double stuck_nats = -14.0;  ///< limit of ln P of a sequence: 1e-6, with some thousand sequences per motor
  double shift_sd_K = 0.3;    ///< standard deviation of the model's error over such a sequence
  double gate_sd = 5.0;       ///< limit of a standardised innovation; 6e-7 of the good samples exceed it
  double smooth_time_scale_s = 200.0;
  double loose_ratio = 4.0;  ///< unknown heat of the outlier test divided by that of the smoother
  double loose_time_scale_s = 60.0;
};

/// Returns a weight per run and sample (n·s): 1, or 0 for a wrong sample. `fitted` are free runs of a model whose missing heat is at most
/// about `unknown_W` (RMS per node, varying over minutes). A sequence of equal readings is excluded from its own prediction. If more than
/// kMostRejected_share of a sensor's samples would be rejected, all of them are kept.
std::vector<Eigen::VectorXd> weights_by_model(const std::vector<LinearisedRun>& fitted, const std::vector<MeasuredRun>& runs,
                                              double unknown_W, const ModelScreeningRules& rules = {});

}  // namespace heatsoak::estimation
