#include "select/decision.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "base/binomial_bound.h"
#include "base/lanes.h"
#include "select/prospect.h"
#include "select/spread.h"

namespace heatsoak::select {
namespace {

constexpr int kFirstGames = 75;
constexpr int kFirstSamples = 500;

/// Returns the smallest number of samples at which the interval around the same probability lies on one side of the threshold, if the
/// interval of `samples` samples covers it.
int needed_for(double threshold_ratio, double probability_ratio, int samples, bool is_drawn) {
  const int per_draw = is_drawn ? base::kLanes : 1;
  const auto decides = [&](int draws) {
    const base::ShareInterval then = base::share_interval(probability_ratio, draws, error_share(draws, is_drawn));
    return then.low > threshold_ratio || then.high <= threshold_ratio;
  };
  const int now = (samples + per_draw - 1) / per_draw;
  const int most = most_samples_at_all(is_drawn) / per_draw;
  const int first = is_drawn ? kFirstGames : kFirstSamples;
  // The search starts 5 % above the present number: an interval that just touches the threshold needs more samples.
  int low = now;
  int high = now + 1 + now / 20;
  while (!decides(high) && high < most) {
    low = high;
    // Up to the first look the error share is larger, so a smaller number may decide.
    high = std::min({most, 2 * high, low < first ? first : most});
  }
  while (high - low > 1) {
    const int middle = std::midpoint(low, high);
    (decides(middle) ? high : low) = middle;
  }
  return std::min(most, high) * per_draw;
}

LimitingFactor hotter_limit(const MotorEvaluation& result) {
  return result.margin_K <= result.stator_margin_K.value_or(result.margin_K) ? LimitingFactor::winding_temperature
                                                                             : LimitingFactor::stator_temperature;
}

/// Returns the only verdict that both intervals allow, or marginal if they cover a threshold. Without draws the nominal run has decided
/// fail and infeasible; with draws it is only one of many games.
Verdict verdict_of_shares(const MotorEvaluation& result, bool is_drawn) {
  if (!is_drawn && result.verdict != Verdict::pass) {
    return result.verdict;
  }
  if (is_drawn && result.short_interval->low > kMajority) {
    return Verdict::infeasible;
  }
  if (is_drawn && result.probability_interval->low > kMajority) {
    return Verdict::fail;
  }
  return std::max(result.probability_interval->high, result.short_interval->high) > kMarginalProbability ? Verdict::marginal
                                                                                                         : Verdict::pass;
}

}  // namespace

void decide_by_samples(MotorEvaluation& motor, bool is_drawn) {
  const Verdict nominal = motor.verdict;
  motor.verdict = verdict_of_shares(motor, is_drawn);
  if (is_drawn || motor.verdict != nominal) {
    const bool misses_demand = motor.verdict == Verdict::infeasible ||
                               (motor.verdict == Verdict::marginal && motor.short_probability > motor.probability_over_limit);
    motor.limiting_factor = motor.verdict == Verdict::pass ? LimitingFactor::none : misses_demand ? motor.short_limit : hotter_limit(motor);
  }
  motor.samples_needed = samples_needed(motor, is_drawn);
}

int first_samples(bool is_drawn) { return is_drawn ? kFirstGames * base::kLanes : kFirstSamples; }

double error_share(int count, bool is_drawn) {
  constexpr double kFirst_share = 0.5;
  return kError_share * (count <= (is_drawn ? kFirstGames : kFirstSamples) ? kFirst_share : (1.0 - kFirst_share) / kLaterLooks);
}

int most_samples_at_all(bool is_drawn) { return is_drawn ? 80'000 : 1'000'000; }

std::optional<int> samples_needed(const MotorEvaluation& motor, bool is_drawn) {
  std::optional<int> most;
  for (const auto& [threshold_ratio, share_ratio, kind] : open_thresholds(motor, is_drawn)) {
    most = std::max(most.value_or(0), needed_for(threshold_ratio, share_ratio, motor.samples, is_drawn));
  }
  return most;
}

Verdict stated_verdict(const MotorEvaluation& motor) {
  return motor.samples == 0 ? std::max(motor.verdict, Verdict::marginal) : motor.verdict;
}

bool ranks_before(const MotorEvaluation& first, const MotorEvaluation& second) {
  const auto place = [](const MotorEvaluation& each) { return std::tuple(each.verdict, -nearest_margin_K(each)); };
  return place(first) < place(second);
}

Verdict worst_allowed_verdict(const MotorEvaluation& motor) {
  Verdict worst = stated_verdict(motor);
  for (const OpenThreshold& open : open_thresholds(motor, motor.games > 0)) {
    if (open.threshold_ratio == kMajority) {
      worst = std::max(worst, open.kind == kShareShort ? Verdict::infeasible : Verdict::fail);
    }
  }
  return worst;
}

DecidingSamples deciding_samples(const MotorEvaluation& motor) {
  const Prospect prospect(motor);
  return {prospect.deciding_samples(kEvenDecision_share), prospect.deciding_samples(kLikelyDecision_share)};
}

int most_samples(bool is_drawn) { return first_samples(is_drawn) << kMostDoublings; }
int most_samples(const duty::Duty& duty) { return most_samples(duty.shape_data->has_unknowns()); }

bool may_be_decided_by(const Prospect& prospect, int most) {
  const double chance = prospect.decided_probability(most);
  return chance < 1.0 && chance >= kLeastDecision_share;
}

std::vector<MotorEvaluation> evaluate_until_decided(const robot::Robot& robot, const duty::Duty& duty,
                                                    std::span<const duty::WheelDemand> wheels, std::span<const motor::Motor> motors,
                                                    EvaluateOptions options, int most, std::vector<duty::WheelDemand>& draws,
                                                    const RoundsProgress& progress) {
  const bool is_drawn = duty.shape_data->has_unknowns();
  const RoundPlan plan(robot, duty, wheels, motors, most, progress);
  plan.foresee(options, draws);
  const auto run = [&](std::span<const motor::Motor> wanted) {
    add_draws(draws, duty, robot, options.seed, draw_count(duty, options.samples), options.threads, plan.playing());
    options.draws = draws;
    return evaluate(robot, duty, wheels, wanted, options, plan.evaluating(wanted.size(), options.samples));
  };
  std::vector<MotorEvaluation> results = run(motors);
  plan.update(results, options.samples);
  while (options.samples < most) {
    std::vector<motor::Motor> open;
    for (const MotorEvaluation& each : results) {
      if (each.samples_needed && (!is_drawn || may_be_decided_by(Prospect(each), most))) {
        open.push_back(*std::ranges::find(motors, each.motor_id, &motor::Motor::id));
      }
    }
    if (open.empty()) {
      break;
    }
    options.samples = std::min(most, 2 * options.samples);
    for (MotorEvaluation& longer : run(open)) {
      *std::ranges::find(results, longer.motor_id, &MotorEvaluation::motor_id) = std::move(longer);
    }
    plan.update(results, options.samples);
  }
  sort_by_verdict(results);
  return results;
}

}  // namespace heatsoak::select
