#include "select/load_simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "base/diagnostic.h"

namespace heatsoak::select {

LoadSimulation simulate_load(const LoadJob& job) {
  constexpr double kMostTraceRows = 5e6;  // about 1 GB
  const std::vector<duty::WheelDemand> wheels = job.duty.demand(job.robot, job.seed);
  const double duration_s = wheels.front().duration_s();
  if (duration_s / job.every_s > kMostTraceRows) {
    throw base::Failure(base::ExitCode::bad_input,
                        fmt::format("--every {} s makes more than {:.0f} rows out of {:.0f} s; expected a longer time", job.every_s,
                                    kMostTraceRows, duration_s));
  }
  EvaluateOptions nominal;
  nominal.samples = 0;
  nominal.with_curves = job.with_curves;
  MotorEvaluation result = evaluate(job.robot, job.duty, wheels, std::span(&job.motor, 1), nominal).front();
  const duty::WheelDemand& wheel = *std::ranges::find(wheels, result.wheel, &duty::WheelDemand::wheel);
  Trace trace = run_trace(job.robot, job.duty, wheel, job.motor, job.every_s);
  std::optional<UpperPeaks> peaks;
  if (const std::optional<motor::Motor> upper = motor::at_upper_band(job.motor)) {
    nominal.with_curves = false;
    const MotorEvaluation hot = evaluate(job.robot, job.duty, wheels, std::span(&*upper, 1), nominal).front();
    peaks = UpperPeaks{hot.winding_peak_C.nominal, hot.stator_peak_C.nominal};
    result.verdict = with_upper(result.verdict, hot.verdict);
  }
  return {job.robot, job.motor, job.duty, duration_s, std::move(result), peaks, std::move(trace)};
}

}  // namespace heatsoak::select
