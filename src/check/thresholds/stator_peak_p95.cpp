#include "check/thresholds/peak.h"

namespace heatsoak::check::thresholds {

ThresholdType stator_peak_p95() {
  static const std::string kMeaning = peak_p95_meaning("stator");
  return {.name = {},
          .unit = "degC",
          .range = kPlausible_C,
          .meaning = kMeaning,
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
