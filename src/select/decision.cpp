#include "select/decision.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "base/binomial_bound.h"
#include "base/lanes.h"
#include "select/spread.h"

namespace heatsoak {
namespace {

constexpr int kFirstGames = 75;
constexpr int kFirstSamples = 500;

/// More samples for one threshold: the smallest number at which the interval around the same share lies on one side of it.
std::optional<int> needed_for(double threshold_ratio, double probability_ratio, const Interval95& interval, int samples, bool is_drawn) {
  if (interval.low > threshold_ratio || interval.high <= threshold_ratio) {
    return std::nullopt;
  }
  const int per_draw = is_drawn ? kLanes : 1;
  const auto decides = [&](int draws) {
    const ShareInterval then = share_interval(probability_ratio, draws, error_share(draws, is_drawn));
    return then.low > threshold_ratio || then.high <= threshold_ratio;
  };
  const int now = (samples + per_draw - 1) / per_draw;
  const int most = most_samples_at_all(is_drawn) / per_draw;
  const int first = is_drawn ? kFirstGames : kFirstSamples;
  // An interval that just touches the threshold still needs something more.
  int low = now;
  int high = now + 1 + now / 20;
  while (!decides(high) && high < most) {
    low = high;
    // Up to the first look a smaller number may decide than behind it.
    high = std::min({most, 2 * high, low < first ? first : most});
  }
  while (high - low > 1) {
    const int middle = std::midpoint(low, high);
    (decides(middle) ? high : low) = middle;
  }
  return std::min(most, high) * per_draw;
}

}  // namespace

int first_samples(const Duty& duty) { return duty.shape_data->has_unknowns() ? kFirstGames * kLanes : kFirstSamples; }

double error_share(int count, bool is_drawn) {
  constexpr double kFirst_share = 0.5;
  constexpr double kLaterLooks = 7.0;
  return kError_share * (count <= (is_drawn ? kFirstGames : kFirstSamples) ? kFirst_share : (1.0 - kFirst_share) / kLaterLooks);
}

int most_samples_at_all(bool is_drawn) { return is_drawn ? 80'000 : 1'000'000; }

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
      take(needed_for(kMajority, probability_ratio, interval, motor.samples, is_drawn));
    }
  }
  if (!is_nominally_bad) {
    // One that is above for certain makes the motor marginal whatever the other is.
    const bool is_marginal_for_certain =
        std::ranges::any_of(kinds, [](const auto& kind) { return kind.second.low > kMarginalProbability; });
    for (const auto& [probability_ratio, interval] : kinds) {
      if (!is_marginal_for_certain) {
        take(needed_for(kMarginalProbability, probability_ratio, interval, motor.samples, is_drawn));
      }
    }
  }
  return most;
}

int most_samples(const Duty& duty) {
  constexpr int kFiveDoublings = 32;
  return first_samples(duty) * kFiveDoublings;
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
    for (const MotorEvaluation& each : results) {
      if (each.samples_needed) {
        open.push_back(*std::ranges::find(motors, each.motor_id, &Motor::id));
      }
    }
    if (open.empty()) {
      break;
    }
    options.samples = std::min(most, 2 * options.samples);
    for (MotorEvaluation& longer : run(open)) {
      *std::ranges::find(results, longer.motor_id, &MotorEvaluation::motor_id) = std::move(longer);
    }
  }
  sort_by_verdict(results);
  return results;
}

}  // namespace heatsoak
