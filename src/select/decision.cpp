#include "select/decision.h"

#include <algorithm>
#include <array>
#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
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

}  // namespace

int first_samples(bool is_drawn) { return is_drawn ? kFirstGames * base::kLanes : kFirstSamples; }

double error_share(int count, bool is_drawn) {
  constexpr double kFirst_share = 0.5;
  constexpr double kLaterLooks = 7.0;
  return kError_share * (count <= (is_drawn ? kFirstGames : kFirstSamples) ? kFirst_share : (1.0 - kFirst_share) / kLaterLooks);
}

int most_samples_at_all(bool is_drawn) { return is_drawn ? 80'000 : 1'000'000; }

namespace {

/// A threshold that the interval of a share covers, with that share. `kind`: 0 over the limit, 1 short of the demand.
struct OpenThreshold {
  double threshold_ratio = 0.0;
  double share_ratio = 0.0;
  std::size_t kind = 0;
};

/// Returns the thresholds of the verdict that the intervals cover. On a duty with draws `short_interval` and the majority count too.
std::vector<OpenThreshold> open_thresholds(const MotorEvaluation& motor, const Interval95& short_interval, bool is_drawn) {
  const bool is_nominally_bad = motor.verdict == Verdict::fail || motor.verdict == Verdict::infeasible;
  std::vector<OpenThreshold> open;
  if (motor.samples == 0 || (!is_drawn && is_nominally_bad)) {
    return open;
  }
  const std::array kinds{std::pair(motor.probability_over_limit.value_or(0.0), *motor.probability_interval),
                         std::pair(motor.short_probability.value_or(0.0), short_interval)};
  const auto add = [&](double threshold_ratio) {
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
      const auto& [share_ratio, interval] = kinds.at(kind);
      if (interval.low <= threshold_ratio && interval.high > threshold_ratio) {
        open.push_back({threshold_ratio, share_ratio, kind});
      }
    }
  };
  if (is_drawn) {
    add(kMajority);
  }
  // If one probability is certainly above the threshold, the motor is marginal, whatever the other is.
  const bool is_marginal_for_certain = std::ranges::any_of(kinds, [](const auto& kind) { return kind.second.low > kMarginalProbability; });
  if (!is_nominally_bad && !is_marginal_for_certain) {
    add(kMarginalProbability);
  }
  return open;
}

/// Returns the smallest number in (low, high] for which `holds`, which must be true from some number on; nothing if it is false at `high`.
template <class Holds>
std::optional<int> first_that_holds(int low, int high, const Holds& holds) {
  if (!holds(high)) {
    return std::nullopt;
  }
  while (high - low > 1) {
    const int middle = std::midpoint(low, high);
    (holds(middle) ? high : low) = middle;
  }
  return high;
}

/// Predicts whether a number of draws decides on which side of a threshold a share lies.
class Predicted {
 public:
  Predicted(const OpenThreshold& open, int draws, bool is_drawn)
      : threshold_ratio_(open.threshold_ratio), over_count_(std::round(open.share_ratio * draws)), draws_(draws), is_drawn_(is_drawn) {
    const boost::math::beta_distribution<> share(over_count_ + 0.5, draws - over_count_ + 0.5);
    for (std::size_t i = 0; i < shares_.size(); ++i) {
      shares_[i] = boost::math::quantile(share, (static_cast<double>(i) + 0.5) / static_cast<double>(shares_.size()));
    }
  }

  /// Returns the probability that the interval of `draws` draws in total excludes the threshold.
  [[nodiscard]] double probability(int draws) const {
    const auto interval = [&](int over) {
      return base::share_interval(static_cast<double>(over) / draws, draws, error_share(draws, is_drawn_));
    };
    const int near = static_cast<int>(threshold_ratio_ * draws);
    const std::optional<int> least_above =
        first_that_holds(near - 1, draws, [&](int over) { return interval(over).low > threshold_ratio_; });
    const std::optional<int> least_open = first_that_holds(-1, near + 1, [&](int over) { return interval(over).high > threshold_ratio_; });
    const double more = draws - draws_;
    const auto at_most = [&](double over, double share_ratio) {
      const double later = over - over_count_;
      return later < 0.0 ? 0.0 : later >= more ? 1.0 : boost::math::cdf(boost::math::binomial_distribution<>(more, share_ratio), later);
    };
    double sum = 0.0;
    for (const double share_ratio : shares_) {
      sum += least_open ? at_most(*least_open - 1.0, share_ratio) : 1.0;
      sum += least_above ? 1.0 - at_most(*least_above - 1.0, share_ratio) : 0.0;
    }
    return sum / static_cast<double>(shares_.size());
  }

 private:
  double threshold_ratio_;
  double over_count_;
  int draws_;
  bool is_drawn_;
  std::array<double, 64> shares_{};  ///< quantiles of the share's distribution
};

/// Predicts whether a number of draws decides all open thresholds.
class AllPredicted {
 public:
  AllPredicted(const std::vector<OpenThreshold>& open, int draws, bool is_drawn) {
    for (const OpenThreshold& each : open) {
      of_kind_.at(each.kind).emplace_back(each, draws, is_drawn);
    }
  }
  /// The shares are taken as independent. Of two thresholds of one share the less certain one counts, because both depend on that share.
  [[nodiscard]] double probability(int draws) const {
    double all = 1.0;
    for (const std::vector<Predicted>& kind : of_kind_) {
      double least = 1.0;
      for (const Predicted& each : kind) {
        least = std::min(least, each.probability(draws));
      }
      all *= least;
    }
    return all;
  }

 private:
  std::array<std::vector<Predicted>, 2> of_kind_;
};

/// Returns the number of draws that decide with the probability: at most 5 % more than the smallest.
std::optional<int> deciding_draws(const AllPredicted& predicted, int draws, int most, double probability_ratio) {
  const auto suffices = [&](int count) { return predicted.probability(count) >= probability_ratio; };
  int low = draws;
  int high = draws + 1 + draws / 20;
  while (high < most && !suffices(high)) {
    low = high;
    high = std::min(most, high + 1 + high / 3);
  }
  return first_that_holds(low, high, suffices);
}

}  // namespace

std::optional<int> samples_needed(const MotorEvaluation& motor, const Interval95& short_interval, bool is_drawn) {
  std::optional<int> most;
  for (const auto& [threshold_ratio, share_ratio, kind] : open_thresholds(motor, short_interval, is_drawn)) {
    most = std::max(most.value_or(0), needed_for(threshold_ratio, share_ratio, motor.samples, is_drawn));
  }
  return most;
}

DecidingSamples deciding_samples(const MotorEvaluation& motor) {
  const bool is_drawn = motor.games > 0;
  const int per_draw = is_drawn ? base::kLanes : 1;
  const int draws = (motor.samples + per_draw - 1) / per_draw;
  const int most = most_samples_at_all(is_drawn) / per_draw;
  const std::vector<OpenThreshold> open = open_thresholds(motor, motor.short_interval.value_or(Interval95{}), is_drawn);
  DecidingSamples found;
  if (open.empty()) {
    return found;
  }
  const AllPredicted predicted(open, draws, is_drawn);
  const auto samples_for = [&](double probability_ratio) {
    const std::optional<int> count = deciding_draws(predicted, draws, most, probability_ratio);
    return count ? std::optional(*count * per_draw) : std::nullopt;
  };
  found.half = samples_for(0.5);
  found.nine_in_ten = samples_for(0.9);
  return found;
}

LaterWork later_work(std::span<const int> needed, int samples, int most) {
  LaterWork work;
  for (int count = samples; count < most;) {
    const auto open = static_cast<double>(std::ranges::count_if(needed, [count](int each) { return each > count; }));
    count = std::min(most, 2 * count);
    work.evaluations_count += open;
    work.samples_count += open * count;
  }
  return work;
}

int most_samples(const duty::Duty& duty) {
  constexpr int kOneDoubling = 2;
  constexpr int kFiveDoublings = 32;
  const bool is_drawn = duty.shape_data->has_unknowns();
  return first_samples(is_drawn) * (is_drawn ? kOneDoubling : kFiveDoublings);
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
      if (each.samples_needed && (!is_drawn || *each.samples_needed <= most)) {
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
