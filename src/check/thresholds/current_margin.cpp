#include "check/computations.h"
#include "check/not_evaluated.h"

namespace heatsoak::check::thresholds {
namespace {

Measured measure_current_margin(const Check& check, Computations& computations) {
  const select::MotorEvaluation& result = computations.feasible_evaluation(check);
  if (!result.margin_A) {
    throw NotEvaluated(LimitNeverReached{});
  }
  return {*result.margin_A, 0.0, MarginBasis{result.current_rms_A}};
}

}  // namespace

ThresholdType current_margin() {
  return {.name = {},
          .unit = "A",
          .direction = Bound::at_least,
          .range = base::Range::between(-1e3, 1e3),
          .meaning =
              "rms current that the nominal motor can take in addition at the same speeds until winding or stator reaches its limit, as "
              "far as voltage and driver allow it; negative if the limit is exceeded",
          .example = "at least 0.5 A",
          .needs = {Setting::robot, Setting::duty, Setting::motor},
          .takes = {Setting::samples, Setting::seed, Setting::conditions},
          .loosest = [](const Check&) -> std::optional<LoosestLimit> {
            return LoosestLimit{0.0, LoosestBy::own_limits};
          },
          .measure = measure_current_margin};
}

}  // namespace heatsoak::check::thresholds
