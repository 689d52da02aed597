#pragma once
// Least-squares fit of the two-body model to logs. It knows which samples are good, so its error is that of the model.
#include <vector>

#include "motor.h"
#include "run_log.h"

namespace heatsoak::suite {

struct TwoBodyFit {
  double winding_J_per_K = 0.0;
  double contact_K_per_W = 0.0;
  double stator_J_per_K = 0.0;
  double air_K_per_W = 0.0;
  double no_load_current_A = 0.0;
  double winding_rmse_K = 0.0;
  double stator_rmse_K = 0.0;
};

/// Fits four thermal parameters, the no-load current within the range of the start file, and two start temperatures per run.
TwoBodyFit fit_two_bodies(const Family& family, const std::vector<Log>& logs);

}  // namespace heatsoak::suite
