#include "select/round_plan.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "base/lanes.h"
#include "select/decision.h"

namespace heatsoak::select {
namespace {

const std::string kPlaying = "playing games";
const std::string kEvaluating = "evaluating";

constexpr double kNominalRun_s = 0.026;
constexpr double kBlock_s = 0.0014;

}  // namespace

double evaluation_work_s(double motors_count, int samples) { return motors_count * (kNominalRun_s + kBlock_s * samples / base::kLanes); }

RoundPlan::RoundPlan(const robot::Robot& robot, const duty::Duty& duty, std::span<const duty::WheelDemand> wheels,
                     std::span<const motor::Motor> motors, int most, const RoundsProgress& progress)
    : robot_(robot), duty_(duty), wheels_(wheels), motors_(motors), most_(most), progress_(progress) {}

void RoundPlan::foresee(const EvaluateOptions& options, std::vector<duty::WheelDemand>& draws) const {
  if (!progress_.job) {
    return;
  }
  constexpr int kFewGames = 6;
  constexpr std::size_t kSomeMotors = 6;
  const int all = draw_count(duty_, options.samples);
  const auto first = [&](int drawn) { return round(static_cast<double>(motors_.size()), options.samples, all - drawn); };
  if (all < 4 * kFewGames) {
    expect(first(0), {}, options.samples);
    return;
  }
  std::vector<motor::Motor> some;
  const std::size_t step = (motors_.size() + kSomeMotors - 1) / kSomeMotors;
  for (std::size_t i = 0; i < motors_.size(); ++i) {
    if (i % step == 0 || motors_[i].id == robot_.drive.motor) {
      some.push_back(motors_[i]);
    }
  }
  std::vector<base::JobPhase> phases = round(static_cast<double>(some.size()), kFewGames * base::kLanes, kFewGames);
  std::ranges::move(first(kFewGames), std::back_inserter(phases));
  expect(std::move(phases), {}, options.samples);
  add_draws(draws, duty_, robot_, options.seed, kFewGames, options.threads, playing());
  EvaluateOptions few = options;
  few.draws = draws;
  few.samples = kFewGames * base::kLanes;
  few.with_curves = few.with_bands = false;
  std::vector<Prospect> prospects;
  for (const MotorEvaluation& each : evaluate(robot_, duty_, wheels_, some, few, evaluating(some.size(), few.samples))) {
    prospects.push_back(Prospect::of_few_games(each, duty_.ambient_C.value));
  }
  expect(first(kFewGames), prospects, options.samples);
}

void RoundPlan::update(std::span<const MotorEvaluation> results, int samples) const {
  if (progress_.job) {
    std::vector<Prospect> prospects;
    for (const MotorEvaluation& each : results) {
      prospects.emplace_back(each);
    }
    expect({}, prospects, samples);
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

void RoundPlan::expect(std::vector<base::JobPhase> certain, std::span<const Prospect> prospects, int samples) const {
  std::vector<base::JobPhase> phases = std::move(certain);
  const bool is_drawn = duty_.shape_data->has_unknowns();
  // The prospects may be those of a part of the motors.
  const double scale = prospects.empty() ? 1.0 : static_cast<double>(motors_.size()) / static_cast<double>(prospects.size());
  std::vector<double> ended(prospects.size());
  std::ranges::transform(prospects, ended.begin(),
                         [&](const Prospect& each) { return is_drawn && !may_be_decided_by(each, most_) ? 1.0 : 0.0; });
  for (int count = samples; count < most_;) {
    double none = 1.0;
    double open = 0.0;
    double variance = 0.0;
    for (std::size_t i = 0; i < prospects.size(); ++i) {
      ended[i] = std::max(ended[i], prospects[i].ended_probability(count, most_));
      const double is_open = 1.0 - ended[i];
      none *= std::pow(1.0 - is_open, scale);
      open += scale * is_open;
      variance += scale * is_open * ended[i];
    }
    const int longer = std::min(most_, 2 * count);
    const double any = 1.0 - none;
    constexpr double kNever = 0.01;
    if (any < kNever) {
      break;
    }
    for (base::JobPhase& each : round(open / any, longer, draw_count(duty_, longer) - draw_count(duty_, count))) {
      each.probability = any;
      each.spread = std::hypot(each.spread, std::sqrt(variance) / open);
      phases.push_back(std::move(each));
    }
    count = longer;
  }
  std::ranges::move(progress_.later ? progress_.later(prospects) : std::vector<base::JobPhase>(), std::back_inserter(phases));
  progress_.job.expect(std::move(phases), prospects.empty());
}

}  // namespace heatsoak::select
