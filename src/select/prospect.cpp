#include "select/prospect.h"

#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "base/binomial_bound.h"
#include "base/lanes.h"
#include "select/decision.h"

namespace heatsoak::select {
namespace {

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

/// Fills an array with equally probable values: `at(share)` is the quantile of the distribution.
template <std::size_t count, class At>
std::array<double, count> equally_probable(const At& at) {
  std::array<double, count> values{};
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = at((static_cast<double>(i) + 0.5) / static_cast<double>(count));
  }
  return values;
}

/// Distance of a limit from the median of a log-normal rise, in standard deviations. Infinite if all peaks are equal.
double distance_sd(const Spread95& peak_C, double limit_C, double ambient_C) {
  const double median_K = peak_C.p50.value_or(peak_C.nominal) - ambient_C;
  const double high_K = peak_C.p95.value_or(peak_C.nominal) - ambient_C;
  if (!(median_K > 0.0 && high_K > median_K && limit_C > ambient_C)) {
    return (peak_C.nominal > limit_C ? -1.0 : 1.0) * std::numeric_limits<double>::infinity();
  }
  const double sd = std::log(high_K / median_K) / boost::math::quantile(boost::math::normal(), 0.95);
  return std::log((limit_C - ambient_C) / median_K) / sd;
}

/// Numbers of draws over a limit, of all draws, with which the interval of the share covers a threshold: [first, end).
struct OpenCounts {
  int first = 0;
  int end = 0;
};
OpenCounts open_counts(double threshold_ratio, int draws, bool is_drawn) {
  const auto interval = [&](int over) {
    return base::share_interval(static_cast<double>(over) / draws, draws, error_share(draws, is_drawn));
  };
  const int near = static_cast<int>(threshold_ratio * draws);
  const std::optional<int> least_above = first_that_holds(near - 1, draws, [&](int over) { return interval(over).low > threshold_ratio; });
  const std::optional<int> least_open = first_that_holds(-1, near + 1, [&](int over) { return interval(over).high > threshold_ratio; });
  const int end = least_above.value_or(draws + 1);
  return {std::min(least_open.value_or(end), end), end};
}

/// Returns the probability that `draws` draws in total have [first, end) of them over the limit, after `seen` of `seen_draws`. The share is
/// one of `quantiles_ratio`.
double probability_of_counts(const OpenCounts& counts, std::span<const double> quantiles_ratio, double seen, int seen_draws, int draws) {
  const double more = draws - seen_draws;
  const auto below = [&](double over, double share_ratio) {
    const double later = over - 1.0 - seen;
    return later < 0.0 ? 0.0 : later >= more ? 1.0 : boost::math::cdf(boost::math::binomial_distribution<>(more, share_ratio), later);
  };
  double sum = 0.0;
  for (const double share_ratio : quantiles_ratio) {
    sum += std::max(0.0, below(counts.end, share_ratio) - below(counts.first, share_ratio));
  }
  return sum / static_cast<double>(quantiles_ratio.size());
}

/// Distribution of the share after `over` of `draws`, from Jeffreys' prior.
template <std::size_t count>
std::array<double, count> share_quantiles(double over, double draws) {
  const boost::math::beta_distribution<> distribution(over + 0.5, draws - over + 0.5);
  return equally_probable<count>([&](double of) { return boost::math::quantile(distribution, of); });
}

/// Returns the counts among `open` after which `most` draws decide with less than kLeastDecision_share. They surround the threshold.
OpenCounts hopeless_counts(const OpenCounts& open, double threshold_ratio, int draws, int most) {
  constexpr std::size_t kFewQuantiles = 24;
  const OpenCounts open_then = open_counts(threshold_ratio, most, true);
  const auto is_probable = [&](int over) {
    return probability_of_counts(open_then, share_quantiles<kFewQuantiles>(over, draws), over, draws, most) <= 1.0 - kLeastDecision_share;
  };
  const int middle = std::clamp(static_cast<int>(std::lround(threshold_ratio * draws)), open.first, open.end - 1);
  if (is_probable(middle)) {
    return {middle, middle};
  }
  const int first = *first_that_holds(open.first - 1, middle, [&](int over) { return !is_probable(over); });
  return {first, first_that_holds(middle, open.end, [&](int over) { return over == open.end || is_probable(over); }).value_or(open.end)};
}

}  // namespace

std::vector<OpenThreshold> open_thresholds(const MotorEvaluation& motor, bool is_drawn) {
  const bool is_nominal_bad = !is_drawn && (motor.verdict == Verdict::fail || motor.verdict == Verdict::infeasible);
  std::vector<OpenThreshold> open;
  // A motor that certainly misses the demand in most samples is infeasible, whatever its temperatures are.
  const bool is_infeasible_for_certain = is_drawn && motor.short_interval && motor.short_interval->low > kMajority;
  if (motor.samples == 0 || is_nominal_bad || is_infeasible_for_certain) {
    return open;
  }
  const std::array kinds{std::pair(motor.probability_over_limit.value_or(0.0), *motor.probability_interval),
                         std::pair(motor.short_probability.value_or(0.0), *motor.short_interval)};
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
  if (!is_marginal_for_certain) {
    add(kMarginalProbability);
  }
  return open;
}

Prospect::Prospect(const MotorEvaluation& motor) : motor_id_(motor.motor_id), is_drawn_(motor.games > 0) {
  draws_ = (motor.samples + per_draw() - 1) / per_draw();
  std::array<Share, 2> kinds;
  for (const OpenThreshold& each : open_thresholds(motor, is_drawn_)) {
    Share& share = kinds.at(each.kind);
    share.thresholds_ratio.push_back(each.threshold_ratio);
    share.seen_count = std::round(each.share_ratio * draws_);
  }
  for (Share& share : kinds) {
    if (!share.thresholds_ratio.empty()) {
      share.quantiles_ratio = share_quantiles<kQuantiles>(share.seen_count, draws_);
      open_.push_back(std::move(share));
    }
  }
  if (open_.empty()) {
    passes_ = motor.verdict == Verdict::pass;
  }
}

Prospect Prospect::of_few_games(const MotorEvaluation& few, double ambient_C) {
  Prospect prospect;
  prospect.motor_id_ = few.motor_id;
  if (few.short_probability > kMajority) {
    prospect.passes_ = false;
    return prospect;
  }
  if (few.short_probability > 0.0) {
    const double count = *few.short_probability * few.games;
    prospect.open_.push_back({share_quantiles<kQuantiles>(count, few.games), {kMajority, kMarginalProbability}});
  }
  double near_sd = distance_sd(few.winding_peak_C, few.winding_limit_C, ambient_C);
  if (few.stator_limit_C) {
    near_sd = std::min(near_sd, distance_sd(few.stator_peak_C, *few.stator_limit_C, ambient_C));
  }
  if (std::isfinite(near_sd)) {
    const boost::math::normal distance(near_sd, std::sqrt((1.0 + 0.5 * near_sd * near_sd) / std::max(1, few.games)));
    const auto share_at = [&](double of) { return boost::math::cdf(boost::math::normal(), -boost::math::quantile(distance, of)); };
    prospect.open_.push_back({equally_probable<kQuantiles>(share_at), {kMajority, kMarginalProbability}});
  } else if (near_sd < 0.0) {
    prospect.passes_ = false;
    prospect.open_.clear();
  }
  if (prospect.open_.empty() && !prospect.passes_) {
    prospect.passes_ = true;
  }
  return prospect;
}

int Prospect::per_draw() const { return is_drawn_ ? base::kLanes : 1; }

/// Both thresholds of one share depend on that share, so the less certain one counts.
double Prospect::decided_by_draws(int draws) const {
  double all = 1.0;
  for (const Share& share : open_) {
    double least = 1.0;
    for (const double threshold_ratio : share.thresholds_ratio) {
      const OpenCounts open = open_counts(threshold_ratio, draws, is_drawn_);
      least = std::min(least, 1.0 - probability_of_counts(open, share.quantiles_ratio, share.seen_count, draws_, draws));
    }
    all *= least;
  }
  return all;
}

double Prospect::decided_probability(int samples) const {
  const int draws = (samples + per_draw() - 1) / per_draw();
  return open_.empty() ? 1.0 : draws <= draws_ ? 0.0 : decided_by_draws(draws);
}

double Prospect::ended_probability(int samples, int most) const {
  const int draws = (samples + per_draw() - 1) / per_draw();
  const int most_draws = most / per_draw();
  if (!is_drawn_ || open_.empty() || draws <= draws_ || draws >= most_draws) {
    return decided_probability(samples);
  }
  double none_goes_on = 1.0;
  for (const Share& share : open_) {
    double goes_on = 0.0;
    for (const double threshold_ratio : share.thresholds_ratio) {
      const OpenCounts open = open_counts(threshold_ratio, draws, true);
      if (open.first == open.end) {
        continue;
      }
      const OpenCounts hopeless = hopeless_counts(open, threshold_ratio, draws, most_draws);
      const auto probability = [&](const OpenCounts& counts) {
        return probability_of_counts(counts, share.quantiles_ratio, share.seen_count, draws_, draws);
      };
      goes_on = std::max(goes_on, probability(open) - probability(hopeless));
    }
    none_goes_on *= 1.0 - std::clamp(goes_on, 0.0, 1.0);
  }
  return none_goes_on;
}

double Prospect::pass_probability() const {
  double all = passes_.value_or(true) ? 1.0 : 0.0;
  for (const Share& share : open_) {
    all *= static_cast<double>(std::ranges::count_if(share.quantiles_ratio, [](double each) { return each <= kMarginalProbability; })) /
           static_cast<double>(share.quantiles_ratio.size());
  }
  return all;
}

std::optional<int> Prospect::deciding_samples(double probability_ratio) const {
  if (open_.empty()) {
    return std::nullopt;
  }
  const auto suffices = [&](int draws) { return decided_by_draws(draws) >= probability_ratio; };
  const int most = most_samples_at_all(is_drawn_) / per_draw();
  int low = draws_;
  int high = draws_ + 1 + draws_ / 20;
  while (high < most && !suffices(high)) {
    low = high;
    high = std::min(most, high + 1 + high / 3);
  }
  const std::optional<int> draws = first_that_holds(low, high, suffices);
  return draws ? std::optional(*draws * per_draw()) : std::nullopt;
}

}  // namespace heatsoak::select
