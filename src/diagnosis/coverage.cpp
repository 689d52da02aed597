#include "diagnosis/coverage.h"

#include <algorithm>
#include <cmath>

namespace heatsoak::diagnosis {
namespace {

/// Fraction of the time in each tail that does not count as part of the range.
constexpr double kTail_share = 0.02;
/// Extension of the range, as a fraction of its width or of its upper end.
constexpr double kReach_share = 0.1;
/// Fraction of the time outside the range from which a warning is given.
constexpr double kMuch_share = 0.25;

using Watched = thermal::OperatingQuantity<double>;

/// Returns the values with their durations in s, sorted by value.
std::vector<std::pair<double, double>> held(const std::vector<estimation::MeasuredRun>& runs, const Watched& watched) {
  std::vector<std::pair<double, double>> all;
  for (const estimation::MeasuredRun& run : runs) {
    for (std::size_t k = 0; run.has(watched.signal.value()) && k < run.at.size(); ++k) {
      all.emplace_back(run.at[k].*watched.value, run.time_s[k + 1] - run.time_s[k]);
    }
  }
  std::ranges::sort(all);
  return all;
}

double time_s(const std::vector<std::pair<double, double>>& values) {
  double sum_s = 0.0;
  for (const auto& [value, duration_s] : values) {
    sum_s += duration_s;
  }
  return sum_s;
}

/// Returns the value that is not exceeded for `share` of the time.
double quantile(const std::vector<std::pair<double, double>>& values, double share) {
  double left_s = share * time_s(values);
  for (const auto& [value, duration_s] : values) {
    left_s -= duration_s;
    if (left_s <= 0.0) {
      return value;
    }
  }
  return values.back().first;
}

}  // namespace

std::vector<BeyondTraining> beyond_fitted(const std::vector<estimation::MeasuredRun>& fitted,
                                          const std::vector<estimation::MeasuredRun>& unseen) {
  std::vector<BeyondTraining> beyond;
  for (std::size_t i = 0; i < thermal::kSignalCount; ++i) {
    const Watched& watched = thermal::quantity_of(static_cast<thermal::Signal>(i));
    if (!watched.is_range_compared) {
      continue;
    }
    const auto known = held(fitted, watched);
    const auto wanted = held(unseen, watched);
    if (known.empty() || wanted.empty()) {
      continue;
    }
    const double low = quantile(known, kTail_share);
    const double high = quantile(known, 1.0 - kTail_share);
    const double reach = kReach_share * std::max(high - low, std::abs(high));
    double outside_s = 0.0;
    for (const auto& [value, duration_s] : wanted) {
      outside_s += value < low - reach || value > high + reach ? duration_s : 0.0;
    }
    if (const double share = outside_s / time_s(wanted); share > kMuch_share) {
      beyond.push_back({watched.signal.value(), low, high, share});
    }
  }
  return beyond;
}

}  // namespace heatsoak::diagnosis
