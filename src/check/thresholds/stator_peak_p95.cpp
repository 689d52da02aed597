#include "check/thresholds/peak.h"

namespace heatsoak::check::thresholds {

ThresholdType stator_peak_p95() {
  return {
      .name = {},
      .unit = "degC",
      .range = kPlausible_C,
      .meaning =
          "95th percentile over the samples of the stator's highest temperature, of the wheel whose winding gets hottest: its upper "
          "confidence bound (97.5 %, one-sided) by order statistics, or by bootstrap over the draws if the duty is drawn at random; 72 "
          "samples or more, 160 for such a duty",
      .example = "at most 80 degC",
      .needs = {Setting::robot, Setting::duty, Setting::motor},
      .takes = {Setting::samples, Setting::seed, Setting::conditions},
      .loosest = [](const Check& check) { return own_limit(check, &motor::MotorValues::stator_limit_C, "the motor's own stator limit"); },
      .measure =
          [](const Check& check, Computations& computations) {
            return measured_peak(check, computations, &select::MotorEvaluation::stator_peak_C,
                                 &select::MotorEvaluation::stator_p95_interval_C);
          }};
}

}  // namespace heatsoak::check::thresholds
