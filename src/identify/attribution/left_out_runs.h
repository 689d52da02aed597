// Prediction error of training runs that are left out of the fit, with and without the accepted terms.
#pragma once

#include "identify/attribution/selection.h"

namespace heatsoak {

/// Root mean square errors over all left-out runs and sensors, K. 0 runs: none could be left out.
struct LeftOutErrors {
  int runs = 0;
  double own_K = 0.0;   ///< model with its own parameters, no terms added
  double with_K = 0.0;  ///< model with all accepted terms
};

/// Each training run is predicted by fits to the other ones, with the terms of `found` and without. A run that alone has the condition of a
/// term cannot be left out.
LeftOutErrors left_out_errors(const Selection& found, const std::vector<MeasuredRun>& runs);

}  // namespace heatsoak
