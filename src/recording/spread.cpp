#include "recording/spread.h"

#include <algorithm>
#include <cmath>
#include <ranges>
#include <vector>

#include "base/unknown.h"

namespace heatsoak::recording {
namespace {

/// First five values that are not NaN; for a reversed view the last five.
std::vector<double> first_samples(auto&& values) {
  std::vector<double> first;
  for (const double value : values) {
    if (!std::isnan(value) && first.size() < 5) {
      first.push_back(value);
    }
  }
  return first;
}

}  // namespace

double percentile(std::span<const double> values, double share) {
  constexpr std::size_t kMostValues = 200'000;  // evenly spaced sample of a long log
  std::vector<double> sorted;
  for (std::size_t i = 0; i < values.size(); i += values.size() / kMostValues + 1) {
    if (!std::isnan(values[i])) {
      sorted.push_back(values[i]);
    }
  }
  if (sorted.empty()) {
    return base::kUnknown;
  }
  const auto place = sorted.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(sorted.size() - 1));
  std::ranges::nth_element(sorted, place);
  return *place;
}

double middle_of(std::span<const double> values) { return percentile(values, 0.5); }

double top_of_sizes(std::span<const double> values) {
  std::vector<double> sizes(values.size());
  std::ranges::transform(values, sizes.begin(), [](double value) { return std::abs(value); });
  return percentile(sizes, 0.98);
}

double swing(const Channel& channel) { return percentile(channel.values, 0.98) - percentile(channel.values, 0.02); }

double at_start(const Channel& channel) { return middle_of(first_samples(channel.values)); }

double at_end(const Channel& channel) { return middle_of(first_samples(std::views::reverse(channel.values))); }

double coolest_at_start(const Channel& channel) { return percentile(first_samples(channel.values), 0.0); }

Regression regress(std::span<const double> x, std::span<const double> y) {
  const auto count = static_cast<double>(x.size());
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += x[i] / count;
    mean_y += y[i] / count;
  }
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
    yy += (y[i] - mean_y) * (y[i] - mean_y);
  }
  Regression found{.slope = 0.0, .intercept = mean_y, .correlation_ratio = 0.0, .points = x.size()};
  if (xx > 0.0 && yy > 0.0) {
    found.slope = xy / xx;
    found.intercept = mean_y - found.slope * mean_x;
    found.correlation_ratio = xy / std::sqrt(xx * yy);
  }
  return found;
}

}  // namespace heatsoak::recording
