#include "check/thresholds/peak.h"

namespace heatsoak::check::thresholds {

ThresholdType stator_peak_p95() {
  return {.name = {},
          .unit = "degC",
          .range = kPlausible_C,
          .meaning =
              "95th percentile over the samples of the stator's highest temperature, of the wheel whose winding gets hottest: the upper "
              "confidence bound (97.5 %, one-sided) by order statistics, from at least 72 samples. On a duty that is drawn at random: the "
              "bound by bootstrap over the draws, from at least 160 samples",
          .example = "at most 80 degC",
          .needs = {Setting::robot, Setting::duty, Setting::motor},
          .takes = {Setting::samples, Setting::seed, Setting::conditions},
          .loosest =
              [](const Check& check) {
                const auto own = own_limit(check, &motor::MotorValues::stator_limit_C, LoosestBy::stator_limit);
                return own ? own : own_limit(check, &motor::MotorValues::winding_limit_C, LoosestBy::winding_limit_of_stator);
              },
          .measure =
              [](const Check& check, Computations& computations) {
                return measured_peak(check, computations, &select::MotorEvaluation::stator_peak_C,
                                     &select::MotorEvaluation::stator_p95_interval_C);
              }};
}

}  // namespace heatsoak::check::thresholds
