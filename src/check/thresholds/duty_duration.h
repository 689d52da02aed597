// Duration of a check's duty, from which bounds of a threshold follow.
#pragma once

#include <algorithm>
#include <optional>

#include "check/check_file.h"

namespace heatsoak::check::thresholds {

/// Returns the duration of the duty in s; nothing if it cannot be computed, which the evaluation reports.
inline std::optional<double> duty_duration_s(const Check& check) {
  if (!check.robot || !check.duty) {
    return std::nullopt;
  }
  try {
    double longest_s = 0.0;
    for (const duty::WheelDemand& each : check.duty->demand(*check.robot, check.seed)) {
      longest_s = std::max(longest_s, each.duration_s());
    }
    return longest_s;
  } catch (const base::Failure&) {
    return std::nullopt;
  }
}

}  // namespace heatsoak::check::thresholds
