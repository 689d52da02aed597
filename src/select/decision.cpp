#include "select/decision.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <numeric>
#include <optional>
#include <utility>

#include "base/binomial_bound.h"
#include "base/lanes.h"
#include "select/spread.h"

namespace heatsoak::select {
namespace {

constexpr int kFirstGames = 75;
constexpr int kFirstSamples = 500;

/// Returns the smallest number of samples at which the interval around the same probability lies on one side of the threshold; nothing if
/// it already does.
std::optional<int> needed_for(double threshold_ratio, double probability_ratio, const Interval95& interval, int samples, bool is_drawn) {
  if (interval.low > threshold_ratio || interval.high <= threshold_ratio) {
    return std::nullopt;
  }
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

}  // namespace

int first_samples(const duty::Duty& duty) { return duty.shape_data->has_unknowns() ? kFirstGames * base::kLanes : kFirstSamples; }

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
  const std::array kinds{std::pair(motor.probability_over_limit.value_or(0.0), *motor.probability_interval),
                         std::pair(motor.short_probability.value_or(0.0), short_interval)};
  if (is_drawn) {
    for (const auto& [probability_ratio, interval] : kinds) {
      take(needed_for(kMajority, probability_ratio, interval, motor.samples, is_drawn));
    }
  }
  if (!is_nominally_bad) {
    // If one probability is certainly above the threshold, the motor is marginal, whatever the other is.
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

int most_samples(const duty::Duty& duty) {
  constexpr int kOneDoubling = 2;
  constexpr int kFiveDoublings = 32;
  return first_samples(duty) * (duty.shape_data->has_unknowns() ? kOneDoubling : kFiveDoublings);
}

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// Reports the rounds after the first look as one job. Its length is estimated from the duration of the first look and the samples needed,
/// and is updated after each round.
class LaterRounds {
 public:
  LaterRounds(double s_per_draw, double s_per_sample, base::Progress progress)
      : s_per_draw_(s_per_draw), s_per_sample_(s_per_sample), progress_(std::move(progress)) {}

  /// Begins a round with `draws` new draws and `samples` samples of `motors` motors. Later rounds double the samples until `needed` or
  /// `most`.
  void begin(double draws, double samples, double motors, double needed, double most) {
    done_s_ = seconds_since(begin_);
    play_s_ = s_per_draw_ * draws;
    evaluate_s_ = s_per_sample_ * samples * motors;
    later_s_ = 0.0;
    for (double factor = 2.0; factor * samples / 2.0 < needed && factor * samples / 2.0 < most; factor *= 2.0) {
      later_s_ += factor * (play_s_ + evaluate_s_);
    }
  }
  [[nodiscard]] base::Progress playing() const { return part(done_s_, play_s_, evaluate_s_ + later_s_); }
  [[nodiscard]] base::Progress evaluating() const { return part(done_s_ + play_s_, evaluate_s_, later_s_); }

 private:
  [[nodiscard]] base::Progress part(double before_s, double part_s, double after_s) const {
    if (!progress_) {
      return {};
    }
    return [=, progress = progress_](std::size_t done, std::size_t total) {
      const auto in_ms = [](double time_s) { return static_cast<std::size_t>(1e3 * time_s); };
      const std::size_t all_ms = in_ms(before_s + part_s + after_s) + 1;
      const double share = static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(1, total));
      progress(std::min(all_ms - 1, in_ms(before_s + part_s * share)), all_ms);
    };
  }
  double s_per_draw_;
  double s_per_sample_;
  base::Progress progress_;
  Clock::time_point begin_ = Clock::now();
  double done_s_ = 0.0;
  double play_s_ = 0.0;
  double evaluate_s_ = 0.0;
  double later_s_ = 0.0;
};

}  // namespace

std::vector<MotorEvaluation> evaluate_until_decided(const robot::Robot& robot, const duty::Duty& duty,
                                                    std::span<const duty::WheelDemand> wheels, std::span<const motor::Motor> motors,
                                                    EvaluateOptions options, int most, std::vector<duty::WheelDemand>& draws,
                                                    const base::ProgressFor& progress) {
  double play_s = 0.0;
  double evaluate_s = 0.0;
  const auto run = [&](std::span<const motor::Motor> wanted, const base::Progress& playing, const base::Progress& evaluating) {
    const Clock::time_point begin = Clock::now();
    add_draws(draws, duty, robot, options.seed, draw_count(duty, options.samples), options.threads, playing);
    play_s = seconds_since(begin);
    options.draws = draws;
    std::vector<MotorEvaluation> found = evaluate(robot, duty, wheels, wanted, options, evaluating);
    evaluate_s = seconds_since(begin) - play_s;
    return found;
  };
  std::vector<MotorEvaluation> results =
      run(motors, base::progress_of(progress, "playing games"), base::progress_of(progress, "evaluating"));
  std::optional<LaterRounds> later;
  const bool is_drawn = duty.shape_data->has_unknowns();
  while (options.samples < most) {
    std::vector<motor::Motor> open;
    int needed = 0;
    for (const MotorEvaluation& each : results) {
      if (each.samples_needed && (!is_drawn || *each.samples_needed <= most)) {
        open.push_back(*std::ranges::find(motors, each.motor_id, &motor::Motor::id));
        needed = std::max(needed, *each.samples_needed);
      }
    }
    if (open.empty()) {
      break;
    }
    if (!later) {
      const auto samples = static_cast<double>(options.samples) * static_cast<double>(motors.size());
      later.emplace(play_s / static_cast<double>(std::max<std::size_t>(1, draws.size())), evaluate_s / samples,
                    base::progress_of(progress, "undecided, drawing more samples"));
    }
    const int before = draw_count(duty, options.samples);
    options.samples = std::min(most, 2 * options.samples);
    later->begin(draw_count(duty, options.samples) - before, options.samples, static_cast<double>(open.size()), needed, most);
    for (MotorEvaluation& longer : run(open, later->playing(), later->evaluating())) {
      *std::ranges::find(results, longer.motor_id, &MotorEvaluation::motor_id) = std::move(longer);
    }
  }
  sort_by_verdict(results);
  return results;
}

}  // namespace heatsoak::select
