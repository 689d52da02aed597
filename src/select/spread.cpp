#include "select/spread.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <limits>

#include "base/random.h"

namespace heatsoak {

namespace {

constexpr double kNotKnown = std::numeric_limits<double>::infinity();

}  // namespace

double quantile(std::span<const double> sorted_C, double share) {
  const double place = share * static_cast<double>(sorted_C.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted_C.size() - 1);
  return std::lerp(sorted_C[below], sorted_C[above], place - static_cast<double>(below));
}

Spread95 spread(double nominal_C, std::vector<double> samples_C) {
  if (samples_C.empty()) {
    constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
    return {nominal_C, kNothing, kNothing, kNothing};
  }
  std::ranges::sort(samples_C);
  return {nominal_C, quantile(samples_C, 0.05), quantile(samples_C, 0.5), quantile(samples_C, 0.95)};
}

DrawIntervals sample_intervals(std::span<const double> samples_C, std::span<const char> is_over) {
  constexpr double kTail = 0.025;
  const auto count = static_cast<double>(samples_C.size());
  const double z = -boost::math::quantile(boost::math::normal(), kTail);
  const double share = static_cast<double>(std::ranges::count(is_over, char{1})) / count;
  const double middle = (share + z * z / (2.0 * count)) / (1.0 + z * z / count);
  const double half = z * std::sqrt(share * (1.0 - share) / count + z * z / (4.0 * count * count)) / (1.0 + z * z / count);
  std::vector<double> sorted_C(samples_C.begin(), samples_C.end());
  std::ranges::sort(sorted_C);
  const boost::math::binomial_distribution<> below(count, 0.95);
  const auto at = [&](double place) {
    if (place > count - 1.0) {
      return kNotKnown;
    }
    return sorted_C[static_cast<std::size_t>(std::max(0.0, place))];
  };
  return {{at(boost::math::quantile(below, kTail) - 1.0), at(boost::math::quantile(boost::math::complement(below, kTail)))},
          {std::max(0.0, middle - half), std::min(1.0, middle + half)}};
}

DrawIntervals draw_intervals(std::span<const double> samples_C, std::span<const char> is_over, const SharedDraws& shared) {
  constexpr std::uint64_t kRepeats = 400;
  std::vector<std::vector<std::size_t>> members(shared.draw_count);
  for (std::size_t sample = 0; sample < samples_C.size(); ++sample) {
    members[sample / shared.block_size % shared.draw_count].push_back(sample);
  }
  std::vector<double> p95_C;
  std::vector<double> probability;
  std::vector<double> drawn_C;
  for (std::uint64_t repeat = 0; repeat < kRepeats; ++repeat) {
    Random random(shared.seed, repeat);
    drawn_C.clear();
    double over = 0.0;
    for (std::size_t i = 0; i < shared.draw_count; ++i) {
      for (const std::size_t sample : members[static_cast<std::size_t>(random.uniform() * static_cast<double>(shared.draw_count))]) {
        drawn_C.push_back(samples_C[sample]);
        over += is_over[sample];
      }
    }
    if (!drawn_C.empty()) {
      std::ranges::sort(drawn_C);
      p95_C.push_back(quantile(drawn_C, 0.95));
      probability.push_back(over / static_cast<double>(drawn_C.size()));
    }
  }
  std::ranges::sort(p95_C);
  std::ranges::sort(probability);
  // What no draw has shown may still be: without a hit in n draws up to 3/n of them (Hanley and Lippman-Hand 1983).
  constexpr double kUnseen = 0.05;
  constexpr std::size_t kFewestDraws = 20;
  const double unseen_share = 1.0 - std::pow(kUnseen, 1.0 / static_cast<double>(shared.draw_count));
  return {{quantile(p95_C, 0.025), shared.draw_count < kFewestDraws ? kNotKnown : quantile(p95_C, 0.975)},
          {std::min(quantile(probability, 0.025), 1.0 - unseen_share), std::max(quantile(probability, 0.975), unseen_share)}};
}

}  // namespace heatsoak
