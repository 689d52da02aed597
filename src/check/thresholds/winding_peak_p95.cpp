#include "check/thresholds/peak.h"

namespace heatsoak::check::thresholds {

ThresholdType winding_peak_p95() {
  return {.name = {},
          .unit = "degC",
          .range = kPlausible_C,
          .meaning =
              "95th percentile over the samples of the winding's highest temperature, of the wheel whose winding gets hottest: the upper "
              "confidence bound (97.5 %, one-sided) by order statistics, from at least 72 samples. On a duty that is drawn at random: the "
              "bound by bootstrap over the draws, from at least 160 samples",
          .example = "at most 120 degC",
          .needs = {Setting::robot, Setting::duty, Setting::motor},
          .takes = {Setting::samples, Setting::seed, Setting::conditions},
          .loosest = [](const Check& check) { return own_limit(check, &motor::MotorValues::winding_limit_C, LoosestBy::winding_limit); },
          .measure =
              [](const Check& check, Computations& computations) {
                return measured_peak(check, computations, &select::MotorEvaluation::winding_peak_C,
                                     &select::MotorEvaluation::winding_p95_interval_C);
              }};
}

}  // namespace heatsoak::check::thresholds
