#include "select/round_plan.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "base/binomial_bound.h"
#include "base/lanes.h"
#include "select/decision.h"

namespace heatsoak::select {
namespace {

const std::string kPlaying = "playing games";
const std::string kEvaluating = "evaluating";

constexpr double kNominalRun_s = 0.065;
constexpr double kBlock_s = 0.006;

void append(std::vector<base::JobPhase>& all, std::vector<base::JobPhase> more) { std::ranges::move(more, std::back_inserter(all)); }

/// Returns the probability that a log-normal rise with these percentiles exceeds the limit.
double share_over(const Spread95& peak_C, double limit_C, double ambient_C) {
  const double median_K = peak_C.p50.value_or(peak_C.nominal) - ambient_C;
  const double high_K = peak_C.p95.value_or(peak_C.nominal) - ambient_C;
  if (!(median_K > 0.0 && high_K > median_K && limit_C > ambient_C)) {
    return peak_C.nominal > limit_C ? 1.0 : 0.0;
  }
  const boost::math::normal standard;
  const double sd = std::log(high_K / median_K) / boost::math::quantile(standard, 0.95);
  return boost::math::cdf(boost::math::complement(standard, std::log((limit_C - ambient_C) / median_K) / sd));
}

Interval95 interval_of(double share_ratio, int draws) {
  const base::ShareInterval interval = base::share_interval(share_ratio, draws, error_share(draws, true));
  return {interval.low, interval.high};
}

}  // namespace

double evaluation_work_s(double motors_count, int samples) { return motors_count * (kNominalRun_s + kBlock_s * samples / base::kLanes); }

MotorEvaluation foreseen(const MotorEvaluation& few, int samples, double ambient_C) {
  MotorEvaluation result = few;
  result.samples = samples;
  result.games = (samples + base::kLanes - 1) / base::kLanes;
  double over = share_over(few.winding_peak_C, few.winding_limit_C, ambient_C);
  if (few.stator_limit_C) {
    over = std::max(over, share_over(few.stator_peak_C, *few.stator_limit_C, ambient_C));
  }
  const double missed = few.short_probability.value_or(0.0);
  result.probability_over_limit = over;
  result.probability_interval = interval_of(over, result.games);
  result.short_interval = interval_of(missed, result.games);
  const bool is_marginal = std::max(result.probability_interval->high, missed) > kMarginalProbability;
  result.verdict = missed > kMajority ? Verdict::infeasible
                   : over > kMajority ? Verdict::fail
                   : is_marginal      ? Verdict::marginal
                                      : Verdict::pass;
  result.samples_needed = samples_needed(result, *result.short_interval, true);
  return result;
}

RoundPlan::RoundPlan(const robot::Robot& robot, const duty::Duty& duty, std::span<const duty::WheelDemand> wheels,
                     std::span<const motor::Motor> motors, int most, const RoundsProgress& progress)
    : robot_(robot), duty_(duty), wheels_(wheels), motors_(motors), most_(most), progress_(progress) {}

void RoundPlan::foresee(EvaluateOptions options, std::vector<duty::WheelDemand>& draws) const {
  if (!progress_.job) {
    return;
  }
  constexpr int kFewGames = 6;
  constexpr std::size_t kSomeMotors = 6;
  const int all = draw_count(duty_, options.samples);
  const auto first = [&](int drawn, std::span<const MotorEvaluation> known) {
    std::vector<base::JobPhase> phases = round(static_cast<double>(motors_.size()), options.samples, all - drawn);
    append(phases, rounds_after(known, options.samples));
    append(phases, later(known));
    return phases;
  };
  if (all < 4 * kFewGames) {
    progress_.job.expect(first(0, {}), true);
    return;
  }
  std::vector<motor::Motor> some;
  const std::size_t step = (motors_.size() + kSomeMotors - 1) / kSomeMotors;
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    if (i % step == 0 || motors_[i].id == robot_.drive.motor) {
      some.push_back(motors_[i]);
    }
  }
  const int samples = options.samples;
  const auto count = static_cast<double>(some.size());
  std::vector<base::JobPhase> phases = round(count, kFewGames * base::kLanes, kFewGames);
  append(phases, first(kFewGames, {}));
  progress_.job.expect(std::move(phases), true);
  add_draws(draws, duty_, robot_, options.seed, kFewGames, options.threads, playing());
  options.draws = draws;
  options.samples = kFewGames * base::kLanes;
  options.with_curves = options.with_bands = false;
  std::vector<MotorEvaluation> known = evaluate(robot_, duty_, wheels_, some, options, evaluating(some.size(), options.samples));
  std::ranges::transform(known, known.begin(), [&](const MotorEvaluation& each) { return foreseen(each, samples, duty_.ambient_C.value); });
  options.samples = samples;
  progress_.job.expect(first(kFewGames, known));
}

void RoundPlan::update(std::span<const MotorEvaluation> results, int samples) const {
  if (progress_.job) {
    std::vector<base::JobPhase> phases = rounds_after(results, samples);
    append(phases, later(results));
    progress_.job.expect(std::move(phases));
  }
}

base::Progress RoundPlan::playing() const { return duty_.shape_data->has_unknowns() ? progress_.job.begin(kPlaying) : base::Progress(); }

base::Progress RoundPlan::evaluating(std::size_t motors, int samples) const {
  if (!progress_.job) {
    return {};
  }
  // evaluate() counts nominal runs and blocks of samples alike, but they take different times.
  const auto work_ms = [](std::size_t nominal, std::size_t blocks) {
    return static_cast<std::size_t>(1e3 * (kNominalRun_s * static_cast<double>(nominal) + kBlock_s * static_cast<double>(blocks)));
  };
  const auto blocks = static_cast<std::size_t>((samples + base::kLanes - 1) / base::kLanes);
  const std::size_t all_ms = work_ms(motors, motors * blocks);
  return [=, progress = progress_.job.begin(kEvaluating)](std::size_t done, std::size_t /*total*/) {
    const std::size_t nominal = std::min(done, motors);
    progress(work_ms(nominal, done - nominal), all_ms);
  };
}

std::vector<base::JobPhase> RoundPlan::round(double motors_count, int samples, int draws) const {
  std::vector<base::JobPhase> phases;
  if (duty_.shape_data->has_unknowns()) {
    phases.push_back({kPlaying, kDraw_s * draws});
  }
  phases.push_back({kEvaluating, evaluation_work_s(motors_count, samples)});
  return phases;
}

std::vector<base::JobPhase> RoundPlan::rounds_after(std::span<const MotorEvaluation> results, int samples) const {
  std::vector<int> needed;
  for (const MotorEvaluation& each : results) {
    if (each.samples_needed && (!duty_.shape_data->has_unknowns() || *each.samples_needed <= most_)) {
      needed.push_back(*each.samples_needed);
    }
  }
  std::vector<base::JobPhase> phases;
  // The results may be those of a part of the motors.
  const double scale = results.empty() ? 1.0 : static_cast<double>(motors_.size()) / static_cast<double>(results.size());
  for (int count = samples; count < most_;) {
    const int longer = std::min(most_, 2 * count);
    const double open = later_work(needed, count, longer).evaluations_count;
    if (open == 0.0) {
      break;
    }
    append(phases, round(scale * open, longer, draw_count(duty_, longer) - draw_count(duty_, count)));
    count = longer;
  }
  return phases;
}

std::vector<base::JobPhase> RoundPlan::later(std::span<const MotorEvaluation> results) const {
  return progress_.later ? progress_.later(results) : std::vector<base::JobPhase>();
}

}  // namespace heatsoak::select
