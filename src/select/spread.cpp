#include "select/spread.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/random.h"

namespace heatsoak {

double quantile(std::span<const double> sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], place - static_cast<double>(below));
}

Spread95 spread(double nominal, std::vector<double> samples) {
  if (samples.empty()) {
    constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
    return {nominal, kNothing, kNothing, kNothing};
  }
  std::ranges::sort(samples);
  return {nominal, quantile(samples, 0.05), quantile(samples, 0.5), quantile(samples, 0.95)};
}

DrawIntervals draw_intervals(std::span<const double> samples, std::span<const char> is_over, const SharedDraws& shared) {
  constexpr std::uint64_t kRepeats = 400;
  std::vector<std::vector<std::size_t>> members(shared.draw_count);
  for (std::size_t sample = 0; sample < samples.size(); ++sample) {
    members[sample / shared.block_size % shared.draw_count].push_back(sample);
  }
  std::vector<double> p95;
  std::vector<double> probability;
  std::vector<double> drawn;
  for (std::uint64_t repeat = 0; repeat < kRepeats; ++repeat) {
    Random random(shared.seed, repeat);
    drawn.clear();
    double over = 0.0;
    for (std::size_t i = 0; i < shared.draw_count; ++i) {
      for (const std::size_t sample : members[static_cast<std::size_t>(random.uniform() * static_cast<double>(shared.draw_count))]) {
        drawn.push_back(samples[sample]);
        over += is_over[sample];
      }
    }
    if (!drawn.empty()) {
      std::ranges::sort(drawn);
      p95.push_back(quantile(drawn, 0.95));
      probability.push_back(over / static_cast<double>(drawn.size()));
    }
  }
  std::ranges::sort(p95);
  std::ranges::sort(probability);
  return {{quantile(p95, 0.025), quantile(p95, 0.975)}, {quantile(probability, 0.025), quantile(probability, 0.975)}};
}

}  // namespace heatsoak
