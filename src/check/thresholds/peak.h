// What the thresholds on peak temperatures share.
#pragma once

#include <fmt/format.h>

#include "check/computations.h"

namespace heatsoak::thresholds {

/// The 95th percentile of a peak, with the air as the origin of its rise. Throws Failure where the samples are too few for it.
inline Measured measured_peak(const Check& check, Computations& computations, Spread95 MotorEvaluation::*peak) {
  constexpr int kFewest = 20;
  if (check.samples < kFewest) {
    throw Failure(ExitCode::bad_input, fmt::format("a 95th percentile needs {} samples or more; the check has {}", kFewest, check.samples));
  }
  const MotorEvaluation& result = computations.feasible_evaluation(check);
  const Spread95& peak_C = result.*peak;
  return {peak_C.p95, check.duty->ambient_C.value,
          fmt::format("nominal {:.1f} °C, median {:.1f} °C, {} samples, {}", peak_C.nominal, peak_C.p50, check.samples, result.wheel)};
}

}  // namespace heatsoak::thresholds
