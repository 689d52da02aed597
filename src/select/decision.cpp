#include "select/decision.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/lanes.h"

namespace heatsoak {
namespace {

/// More samples for one threshold: the interval has to shrink until its end on the threshold's side lies at the threshold.
std::optional<int> needed_for(double threshold_ratio, double probability_ratio, const Interval95& interval, int samples) {
  if (interval.low > threshold_ratio || interval.high <= threshold_ratio) {
    return std::nullopt;
  }
  const double reach = threshold_ratio > probability_ratio ? interval.high - probability_ratio : probability_ratio - interval.low;
  const double distance = std::abs(threshold_ratio - probability_ratio);
  const double growth = reach / std::max(distance, 1e-9);
  // An interval that just touches the threshold still needs something more.
  return static_cast<int>(std::ceil(std::clamp(samples * growth * growth, 1.05 * samples, double{kMostNeeded})));
}

}  // namespace

std::optional<int> samples_needed(const MotorEvaluation& motor, const Interval95& short_interval, bool is_drawn) {
  const bool is_nominally_bad = motor.verdict == Verdict::fail || motor.verdict == Verdict::infeasible;
  if (motor.samples == 0 || (!is_drawn && is_nominally_bad)) {
    return std::nullopt;
  }
  std::optional<int> most;
  const auto take = [&most](const std::optional<int>& needed) {
    if (needed && *needed > most.value_or(0)) {
      most = needed;
    }
  };
  const std::array kinds{std::pair(motor.probability_over_limit, *motor.probability_interval),
                         std::pair(motor.short_probability, short_interval)};
  if (is_drawn) {
    for (const auto& [probability_ratio, interval] : kinds) {
      take(needed_for(kMajority, probability_ratio, interval, motor.samples));
    }
  }
  if (!is_nominally_bad) {
    // One that is above for certain makes the motor marginal whatever the other is.
    const bool is_marginal_for_certain =
        std::ranges::any_of(kinds, [](const auto& kind) { return kind.second.low > kMarginalProbability; });
    for (const auto& [probability_ratio, interval] : kinds) {
      if (!is_marginal_for_certain) {
        take(needed_for(kMarginalProbability, probability_ratio, interval, motor.samples));
      }
    }
  }
  return most;
}

int most_samples(const Duty& duty) {
  constexpr int kMostWithoutDraws = 16000;
  return duty.shape_data->has_unknowns() ? kMostDraws * kLanes : kMostWithoutDraws;
}

std::vector<MotorEvaluation> evaluate_until_decided(const Robot& robot, const Duty& duty, std::span<const WheelDemand> wheels,
                                                    std::span<const Motor> motors, EvaluateOptions options, int most,
                                                    std::vector<WheelDemand>& draws, const ProgressFor& progress) {
  const auto progress_for = [&](const char* what) { return progress ? progress(what) : Progress(); };
  const auto run = [&](std::span<const Motor> wanted) {
    add_draws(draws, duty, robot, options.seed, draw_count(duty, options.samples), options.threads, progress_for("playing games"));
    options.draws = draws;
    return evaluate(robot, duty, wheels, wanted, options, progress_for("evaluating"));
  };
  std::vector<MotorEvaluation> results = run(motors);
  while (options.samples < most) {
    std::vector<Motor> open;
    int needed = 0;
    for (const MotorEvaluation& each : results) {
      if (each.samples_needed) {
        open.push_back(*std::ranges::find(motors, each.motor_id, &Motor::id));
        needed = std::max(needed, *each.samples_needed);
      }
    }
    if (open.empty()) {
      break;
    }
    options.samples = std::min(most, std::max(2 * options.samples, needed));
    for (MotorEvaluation& longer : run(open)) {
      *std::ranges::find(results, longer.motor_id, &MotorEvaluation::motor_id) = std::move(longer);
    }
  }
  sort_by_verdict(results);
  return results;
}

}  // namespace heatsoak
