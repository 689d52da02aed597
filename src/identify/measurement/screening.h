// Samples that no sensor in order can give: temperatures frozen, saturated, outliers, and wild heat inputs.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "identify/measurement/recording.h"
#include "identify/measurement/recording_report.h"

namespace heatsoak {

/// Makes them NaN and reports them by line. Heat inputs and other signals may rightly jump and rest: they stay as they are, but for a
/// few currents and speeds that no motor reaches, far beyond their neighbours (outliers).
/// - frozen: exactly one value for longer than the channel's noise allows, until an isolated jump frees it or for good after
///   a slope. A still sensor whose temperature is still too gives no false value and stays.
/// - saturated: a climb that stops dead at the largest or smallest value, or noise cut off there.
/// - outlier: further from the median of its seven neighbours than 6 median deviations (Hampel), and than 4 usual changes.
/// A log comes in parts, always with the same channels; of what went before only extremes and what was frozen are kept.
class Screening {
 public:
  /// Of `part` the rows [first, last) are reported; those around them are their neighbours.
  void leave_out_bad_samples(Recording& part, std::size_t first, std::size_t last, RecordingReport& report);

 private:
  struct Past {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
    double value = std::numeric_limits<double>::quiet_NaN();  ///< at which it is frozen in the row before the part; NaN: it is not
  };
  std::vector<Past> past_;  ///< per channel
};

}  // namespace heatsoak
