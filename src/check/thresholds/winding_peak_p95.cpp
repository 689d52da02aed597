#include "check/thresholds/peak.h"

namespace heatsoak::check::thresholds {

ThresholdType winding_peak_p95() {
  static const std::string kMeaning = peak_p95_meaning("winding");
  return {.name = {},
          .unit = "degC",
          .range = kPlausible_C,
          .meaning = kMeaning,
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
