// Evaluations with made-up results.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "duty/duty.h"
#include "simulate/evaluation.h"
#include "support/shipped.h"

namespace heatsoak::present {

/// Returns a motor of which `probability` of the samples exceed a limit, with the interval of this share.
inline select::MotorEvaluation sampled(double probability, select::Interval95 interval, int samples) {
  select::MotorEvaluation motor;
  motor.samples = samples;
  motor.probability_over_limit = probability;
  motor.probability_interval = interval;
  motor.short_interval = select::Interval95{0.0, 0.01};
  return motor;
}

/// Returns the evaluation of these motors for a shipped robot and duty.
inline simulate::EvaluationAnswer answer_with(std::vector<select::MotorEvaluation> results,
                                              const std::string& duty = "paper_intermittent") {
  for (select::MotorEvaluation& each : results) {
    each.winding_p95_interval_C = each.winding_p95_interval_C.value_or(select::Interval95{40.0, 50.0});
  }
  simulate::EvaluationAnswer answer{.robot = twente(),
                                    .duty = duty::read_duty(kSource / "duty_profiles" / (duty + ".toml")),
                                    .motors = {},
                                    .conditions = {},
                                    .demand = {},
                                    .results = std::move(results),
                                    .rests = {},
                                    .closed_loop = {},
                                    .ranks = {},
                                    .changes = {}};
  answer.robot.drive.current_limit_A = 4.0;  // some motors here are limited by it
  return answer;
}

}  // namespace heatsoak::present
