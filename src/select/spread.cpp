#include "select/spread.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <limits>

#include "base/binomial_bound.h"
#include "base/lanes.h"
#include "base/random.h"

namespace heatsoak::select {

namespace {

constexpr double kTail_share = 0.5 * kError_share;
using base::kHighPercentile_share;
constexpr std::size_t kFewestDraws = 20;
constexpr double kNotKnown = std::numeric_limits<double>::infinity();

Interval95 probability_interval(std::span<const char> is_over, std::size_t trials, double error_share) {
  const double share = static_cast<double>(std::ranges::count(is_over, char{1})) / static_cast<double>(is_over.size());
  const base::ShareInterval interval = base::share_interval(share, static_cast<double>(trials), error_share);
  return {interval.low, interval.high};
}

}  // namespace

double quantile(std::span<const double> sorted_C, double share) {
  const double place = share * static_cast<double>(sorted_C.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted_C.size() - 1);
  return std::lerp(sorted_C[below], sorted_C[above], place - static_cast<double>(below));
}

Spread95 spread(double nominal_C, std::vector<double> samples_C) {
  if (samples_C.empty()) {
    return {.nominal = nominal_C};
  }
  std::ranges::sort(samples_C);
  return {nominal_C, quantile(samples_C, base::kLowPercentile_share), quantile(samples_C, 0.5), quantile(samples_C, kHighPercentile_share)};
}

int fewest_samples_for_bound(bool is_drawn) {
  return is_drawn ? static_cast<int>(kFewestDraws) * base::kLanes
                  : static_cast<int>(std::ceil(std::log(kTail_share) / std::log(kHighPercentile_share)));
}

DrawIntervals sample_intervals(std::span<const double> samples_C, std::span<const char> is_over, double error_share) {
  const auto count = static_cast<double>(samples_C.size());
  std::vector<double> sorted_C(samples_C.begin(), samples_C.end());
  std::ranges::sort(sorted_C);
  const boost::math::binomial_distribution<> below(count, kHighPercentile_share);
  const auto at = [&](double place) {
    if (place > count - 1.0) {
      return kNotKnown;
    }
    return sorted_C[static_cast<std::size_t>(std::max(0.0, place))];
  };
  return {{at(boost::math::quantile(below, kTail_share) - 1.0), at(boost::math::quantile(boost::math::complement(below, kTail_share)))},
          probability_interval(is_over, samples_C.size(), error_share)};
}

DrawIntervals draw_intervals(std::span<const double> samples_C, std::span<const char> is_over, const SharedDraws& shared,
                             double error_share) {
  constexpr std::uint64_t kRepeats = 400;
  std::vector<std::vector<std::size_t>> members(shared.draw_count);
  for (std::size_t sample = 0; sample < samples_C.size(); ++sample) {
    members[sample / shared.block_size % shared.draw_count].push_back(sample);
  }
  std::vector<double> p95_C;
  std::vector<double> drawn_C;
  for (std::uint64_t repeat = 0; repeat < kRepeats; ++repeat) {
    base::Random random(shared.seed, repeat);
    drawn_C.clear();
    for (std::size_t i = 0; i < shared.draw_count; ++i) {
      for (const std::size_t sample : members[static_cast<std::size_t>(random.uniform() * static_cast<double>(shared.draw_count))]) {
        drawn_C.push_back(samples_C[sample]);
      }
    }
    if (!drawn_C.empty()) {
      const auto place = drawn_C.begin() + static_cast<std::ptrdiff_t>(kHighPercentile_share * static_cast<double>(drawn_C.size() - 1));
      std::nth_element(drawn_C.begin(), place, drawn_C.end());
      // After nth_element the next order statistic is the smallest of the elements behind `place`.
      const double above_C = place + 1 == drawn_C.end() ? *place : *std::min_element(place + 1, drawn_C.end());
      const double exact = kHighPercentile_share * static_cast<double>(drawn_C.size() - 1);
      p95_C.push_back(std::lerp(*place, above_C, exact - std::floor(exact)));
    }
  }
  std::ranges::sort(p95_C);
  return {{quantile(p95_C, kTail_share), shared.draw_count < kFewestDraws ? kNotKnown : quantile(p95_C, 1.0 - kTail_share)},
          probability_interval(is_over, shared.draw_count, error_share)};
}

}  // namespace heatsoak::select
