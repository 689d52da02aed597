#include <algorithm>
#include <cmath>

#include "check/computations.h"
#include "check/thresholds/duty_duration.h"
#include "select/trace.h"

namespace heatsoak::check::thresholds {
namespace {

/// Returns the time in s during which a straight line from `from_C` to `to_C` is above the limit.
double above_s(double from_C, double to_C, double limit_C, double duration_s) {
  if (from_C > limit_C && to_C > limit_C) {
    return duration_s;
  }
  if (from_C <= limit_C && to_C <= limit_C) {
    return 0.0;
  }
  return duration_s * (std::max(from_C, to_C) - limit_C) / std::abs(to_C - from_C);
}

Measured measure_time_above(const Check& check, Computations& computations) {
  const select::MotorEvaluation& result = computations.feasible_evaluation(check);
  const std::vector<duty::WheelDemand>& wheels = computations.demand(check);
  const duty::WheelDemand& hottest = *std::ranges::find(wheels, result.wheel, &duty::WheelDemand::wheel);
  constexpr double kEvery_s = 1.0;
  const double limit_C = check.temperature_C.value();
  const select::Trace trace = select::run_trace(*check.robot, *check.duty, hottest, *check.motor, kEvery_s);
  double sum_s = 0.0;
  for (std::size_t i = 1; i < trace.rows.size(); ++i) {
    const select::TraceRow& before = trace.rows[i - 1];
    const select::TraceRow& row = trace.rows[i];
    sum_s += above_s(before.winding_C, row.winding_C, limit_C, row.time_s - before.time_s);
  }
  return {sum_s, 0.0, TimeAboveBasis{limit_C, hottest.duration_s(), result.winding_peak_C.nominal}};
}

/// The time above a temperature never exceeds the duration of the duty, and time above more than the motor's own limit comes too late.
std::optional<LoosestLimit> loosest(const Check& check) {
  if (check.motor && check.temperature_C && *check.temperature_C > check.motor->nominal.winding_limit_C) {
    return LoosestLimit{.refusal = CountedTooHot{*check.temperature_C, check.motor->nominal.winding_limit_C}};
  }
  const std::optional<double> duration_s = duty_duration_s(check);
  return duration_s ? std::optional<LoosestLimit>({*duration_s, LoosestBy::duty_duration, true}) : std::nullopt;
}

}  // namespace

ThresholdType time_above() {
  return {.name = {},
          .unit = "s",
          .range = base::Range::between(0.0, 1e7),
          .meaning = "time in which the winding of the hottest wheel is above 'temperature', of the nominal motor over the whole duty",
          .example = "at most 60 s",
          .needs = {Setting::robot, Setting::duty, Setting::motor, Setting::temperature},
          .takes = {Setting::samples, Setting::seed, Setting::conditions},
          .loosest = loosest,
          .measure = measure_time_above};
}

}  // namespace heatsoak::check::thresholds
