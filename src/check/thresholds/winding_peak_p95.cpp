#include "check/thresholds/peak.h"

namespace heatsoak::thresholds {

ThresholdType winding_peak_p95() {
  return {.name = {},
          .unit = "degC",
          .meaning =
              "95th percentile over the samples of the winding's highest temperature, of the wheel whose winding gets hottest; 20 "
              "samples or more",
          .example = "at most 120 degC",
          .needs = {Setting::robot, Setting::duty, Setting::motor},
          .takes = {Setting::samples, Setting::seed, Setting::conditions},
          .measure = [](const Check& check, Computations& computations) {
            return measured_peak(check, computations, &MotorEvaluation::winding_peak_C);
          }};
}

}  // namespace heatsoak::thresholds
