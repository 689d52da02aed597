// Detects invalid samples: frozen or saturated temperatures, outliers, and impossible heat inputs.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "recording/recording.h"
#include "recording/recording_report.h"

namespace heatsoak::recording {

/// Replaces invalid samples by NaN and reports their lines. Heat inputs and other signals may jump and rest, so they are kept. Exceptions
/// are single currents and speeds that no motor reaches and that are far from their neighbours (outliers).
/// - frozen: exactly one value for longer than the channel's noise allows; or one value until an isolated jump, or to the end of the run
///   after a slope. A constant reading of a constant temperature is valid.
/// - saturated: a climb that stops abruptly at the largest or smallest value, or noise that is cut off there.
/// - outlier: far from the medians of the three valid samples before and after, or from the straight lines through them, and on the same
///   side of both.
/// Logs are processed in parts with the same channels; between parts only extremes and frozen values are remembered.
class Screening {
 public:
  /// Screens `part` and reports its rows [first, last); the other rows serve as neighbours.
  void leave_out_bad_samples(Recording& part, std::size_t first, std::size_t last, RecordingReport& report);

 private:
  struct Past {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
    std::optional<double> value = {};  ///< frozen value in the row before the part
  };
  std::vector<Past> past_;  ///< per channel
};

}  // namespace heatsoak::recording
