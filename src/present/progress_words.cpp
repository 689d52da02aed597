#include "present/progress_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace heatsoak::present {
namespace {

/// Time in the unit that is shown.
struct Time {
  double number = 0.0;
  std::string_view unit;

  [[nodiscard]] Time rounded_down() const { return {std::max(1.0, std::floor(number)), unit}; }
  [[nodiscard]] Time rounded_up() const { return {std::ceil(number), unit}; }
  [[nodiscard]] Time rounded() const { return {std::max(1.0, std::round(number)), unit}; }
  [[nodiscard]] std::string words() const { return fmt::format("{:.0f} {}", number, unit); }
};

/// Up to two minutes in seconds.
Time in_unit(double time_s) {
  constexpr double kLong_s = 120.0;
  return time_s > kLong_s ? Time{time_s / 60.0, "min"} : Time{time_s, "s"};
}

/// Times below one second need no distinction.
double distinct_s(double time_s) { return std::max(1.0, time_s); }

std::string range_words(double shortest_s, double longest_s) {
  const Time shortest = in_unit(shortest_s).rounded_down();
  const Time longest = in_unit(longest_s).rounded_up();
  return shortest.unit == longest.unit ? fmt::format("{:.0f} to {}", shortest.number, longest.words())
                                       : fmt::format("{} to {}", shortest.words(), longest.words());
}

}  // namespace

std::string progress_words(const base::JobEstimate& estimate, double& most_share) {
  constexpr double kWide_ratio = 2.0;
  constexpr double kMost_share = 0.99;
  const base::RemainingTime time = estimate.remaining.value_or(base::RemainingTime{});
  if (estimate.is_open) {
    return fmt::format("{}: at least {} left", estimate.what, in_unit(distinct_s(time.p025_s)).rounded_down().words());
  }
  most_share = std::max(most_share, std::min(estimate.done_share, kMost_share));
  const double low_s = distinct_s(time.p025_s);
  const double high_s = distinct_s(time.p975_s);
  // Nobody plans with the last seconds.
  constexpr double kShort_s = 5.0;
  if (time.p975_s <= kShort_s) {
    return fmt::format("{}: {:.0f} %, less than {:.0f} s left", estimate.what, 100.0 * most_share, kShort_s);
  }
  if (high_s > kWide_ratio * kWide_ratio * low_s) {
    return fmt::format("{}: {} left", estimate.what, range_words(low_s, high_s));
  }
  // This time is within a factor of two of both ends.
  const double likely_s = std::clamp(time.p50_s, high_s / kWide_ratio, kWide_ratio * low_s);
  return fmt::format("{}: {:.0f} %, {} left", estimate.what, 100.0 * most_share, in_unit(likely_s).rounded().words());
}

}  // namespace heatsoak::present
