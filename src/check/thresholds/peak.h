// Shared parts of the thresholds on peak temperatures.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>

#include "check/computations.h"
#include "check/not_evaluated.h"
#include "select/spread.h"

namespace heatsoak::check::thresholds {

/// Range of plausible limits. A limit of 70 K that means a rise is outside of it, because it is −203 °C.
inline constexpr base::Range kPlausible_C = base::Range::between(-60.0, 1000.0);

/// Returns the definition of the threshold on the peak of one part, "winding" or "stator".
inline std::string peak_p95_meaning(std::string_view part) {
  return fmt::format(
      "95th percentile over the samples of the {}'s highest temperature, of the wheel whose winding gets hottest: the upper confidence "
      "bound ({:.3g} %, one-sided) by order statistics, from at least {} samples. On a duty that is drawn at random: the bound by "
      "bootstrap "
      "over the draws, from at least {} samples",
      part, 100.0 * kBoundConfidence_share, select::fewest_samples_for_bound(false), select::fewest_samples_for_bound(true));
}

/// Returns the motor's own limit as the loosest one; nothing without a motor or if its file gives no such limit.
template <class Member>
std::optional<LoosestLimit> own_limit(const Check& check, Member motor::MotorValues::*limit_C, LoosestBy origin) {
  const std::optional<double> own_C = check.motor ? std::optional<double>(check.motor->nominal.*limit_C) : std::nullopt;
  return own_C ? std::optional<LoosestLimit>({*own_C, origin}) : std::nullopt;
}

/// Returns the upper end of the 95 % interval of a peak's 95th percentile; the origin is the air temperature. Throws NotEvaluated if there
/// are too few samples for an interval.
inline Measured measured_peak(const Check& check, Computations& computations, select::Spread95 select::MotorEvaluation::*peak,
                              std::optional<select::Interval95> select::MotorEvaluation::*interval) {
  const select::MotorEvaluation& result = computations.feasible_evaluation(check);
  const select::Spread95& peak_C = result.*peak;
  const std::optional<select::Interval95>& bounds_C = result.*interval;
  if (!bounds_C || !peak_C.p50 || !peak_C.p95 || !std::isfinite(bounds_C->high)) {
    throw NotEvaluated(TooFewSamples{check.samples});
  }
  return {bounds_C->high, check.duty->ambient_C.value,
          PeakBasis{.p95_C = *peak_C.p95,
                    .bound_C = bounds_C->high,
                    .nominal_C = peak_C.nominal,
                    .median_C = *peak_C.p50,
                    .samples = check.samples,
                    .wheel = result.wheel}};
}

}  // namespace heatsoak::check::thresholds
