// Samples that the fitted model makes impossible: converters that repeat one value while the temperature moves, and outliers that only a
// prediction shows. The second pass of the screening; Screening is the first, which knows no model.
#pragma once

#include <vector>

#include "identify/linearised_run.h"

namespace heatsoak {

struct ModelScreeningRules {
  int least_equal = 8;        ///< readings of one value, to be judged at all
  double stuck_nats = -14.0;  ///< ln P of all of them: one in a million, of some thousand intervals per motor
  double shift_sd_K = 0.3;    ///< of the model over such an interval
  double gate_sd = 5.0;       ///< of an innovation: 6e-7 of the good samples are further off
  double smooth_time_scale_s = 200.0;
  double loose_ratio = 4.0;  ///< of unknown heat in the gate, in that of the smoother
  double loose_time_scale_s = 60.0;
};

/// Per run and sample (n·s) 1, or 0 for a sample that is wrong. `fitted` are free runs of a model that lacks at most what the unknown heat
/// `unknown_W` (rms per node, over minutes) can make up for. An interval of equal readings does not take part in its own prediction. Where
/// more than a tenth of a sensor's samples would go, the model is at fault and all of them stay.
std::vector<Eigen::VectorXd> weights_by_model(const std::vector<LinearisedRun>& fitted, const std::vector<MeasuredRun>& runs,
                                              double unknown_W, const ModelScreeningRules& rules = {});

}  // namespace heatsoak
